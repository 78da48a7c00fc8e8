// Things of rigid classes: background while they stand, surfaces once they have
// moved.

#include "splitfusion/lib/split/moving_objects.h"

#include <opencv2/imgproc.hpp>

#include "split/splitter_fixture.h"
#include "splitfusion/lib/visibility/seen_space.h"

namespace splitfusion {
namespace {

const cv::Size kChair(40, 60);

cv::Rect ChairAt(int x) { return {cv::Point(x, 40), kChair}; }

/// What a tracker predicts that has mapped the wall alone, at 3 m.
SurfacePrediction WallAlone() {
  return {LabelImage(120, 160, std::uint16_t(0)),
          cv::Mat_<float>(120, 160, 3.0f), cv::Mat_<float>(120, 160, 3.0f)};
}

/// Way of a camera that moves to the right, metres.
double WayToTheRight(int frame) { return 0.03 * frame; }

SurfacePrediction WallFromTheRight(int frame) {
  SurfacePrediction prediction = WallAlone();
  prediction.world_from_camera.translation().x() = WayToTheRight(frame);
  return prediction;
}

/// A standing chair, at first beyond the image's border.
LayeredScene ChairThatComesIntoView(int frame) {
  LayeredScene scene(3.0, frame);
  const double shift = SceneCamera().fx * WayToTheRight(frame) / 2.0;
  scene.Add(ChairAt(static_cast<int>(165 - shift)), 2.0, 1);
  return scene;
}

class MovingObjectsTest : public SplitterTest {
 protected:
  /// A frame with a chair at `x`; a tracker has mapped it at x = 20, where it
  /// is a part of the background, and follows the surface that it became.
  void Step(int x) {
    LayeredScene scene(3.0, next_frame_), mapped;
    scene.Add(ChairAt(x), 2.0, 1);
    mapped.Add(ChairAt(20), 2.0, 1);
    truth_ = scene.Truth(1);
    SurfacePrediction prediction{LabelImage(120, 160, std::uint16_t(0)),
                                 mapped.depth().clone(),
                                 mapped.depth().clone()};
    if (!splitter_.tracks().empty()) {
      prediction.labels.setTo(1, scene.Truth(1));
      prediction.depth.setTo(2.0, scene.Truth(1));
    }
    Split(scene, {{truth_, "chair", 0.8}}, prediction);
  }
  cv::Mat_<uchar> truth_;
};

TEST_F(MovingObjectsTest, AChairBecomesASurfaceWhenItMovesAndStaysOne) {
  for (int i = 0; i < 12; ++i) Step(20);
  EXPECT_EQ(Count("ignored"), 1);
  EXPECT_EQ(cv::countNonZero(last_.labels), 0);
  int x = 20;
  int waited = 0;
  while (splitter_.tracks().empty() && waited < 40) Step(x += 2), ++waited;
  EXPECT_EQ(Count("born"), 1);
  EXPECT_GE(waited, 8);  // It must have moved by more than its wobble.
  EXPECT_LE(waited, 20);
  EXPECT_EQ(splitter_.tracks().at(1).kind, SurfaceKind::kRigid);
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "chair");
  for (int i = 0; i < 40; ++i) {  // It stands, then goes back.
    Step(i < 25 ? x : x -= 2);
    EXPECT_EQ(Count("matched"), 1) << i;
    EXPECT_GT(IouOf(1, truth_), 0.95) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
}

TEST_F(MovingObjectsTest, WhatHasMovedIsNotMappedWhileItWaits) {
  for (int i = 0; i < 12; ++i) Step(20);
  EXPECT_LT(cv::countNonZero(last_.uncertain), 20);
  Step(32);
  const cv::Mat_<uchar> entered = RectMask({62, 42, 10, 56});
  EXPECT_GT(cv::countNonZero(last_.uncertain & entered),
            0.9 * cv::countNonZero(entered));
}

TEST_F(MovingObjectsTest, AChairThatIsBelievedToMoveBecomesASurfaceAtOnce) {
  for (int i = 0; i < 12; ++i) Step(20);
  ASSERT_EQ(last_.standing.size(), 1u);
  splitter_.BelieveMoving(last_.standing.front());
  Step(21);
  EXPECT_EQ(Count("born"), 1);
  EXPECT_TRUE(last_.standing.empty());
  EXPECT_GT(IouOf(1, truth_), 0.95);
  EXPECT_EQ(splitter_.tracks().at(1).kind, SurfaceKind::kRigid);
}

TEST_F(MovingObjectsTest, WhatIsBelievedToMoveIsNoBackgroundWithoutDetection) {
  for (int i = 0; i < 12; ++i) Step(20);
  splitter_.BelieveMoving(last_.standing.front());
  LayeredScene scene(3.0, next_frame_);
  scene.Add(ChairAt(20), 2.0, 1);
  Split(scene, {}, WallAlone());
  EXPECT_EQ(cv::countNonZero(~last_.uncertain & scene.Truth(1)), 0);
  Step(21);
  EXPECT_EQ(Count("born"), 1);
}

TEST_F(MovingObjectsTest, AStandingChairUnderNoisyMasksStaysBackground) {
  cv::RNG random(5);
  for (int i = 0; i < 60; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add(ChairAt(60), 2.0, 1);
    cv::Mat_<uchar> mask =
        Moved(scene.Truth(1), random.uniform(-4, 5), random.uniform(-4, 5));
    const int size = random.uniform(1, 7);
    const cv::Mat kernel = cv::Mat::ones(2 * size + 1, 2 * size + 1, CV_8U);
    if (i % 2 == 0) cv::dilate(mask, mask, kernel);
    if (i % 2 == 1) cv::erode(mask, mask, kernel);
    Split(scene, {{mask, "chair", 0.9}});
    EXPECT_EQ(cv::countNonZero(last_.labels), 0) << i;
  }
  EXPECT_TRUE(splitter_.tracks().empty());
}

TEST_F(MovingObjectsTest, AChairBehindAPassingPersonStaysBackground) {
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add(ChairAt(60), 2.2, 1).Add({3 * i, 5, 46, 112}, 1.5, 2);
    // The detector's chair keeps its shape, on the person too.
    std::vector<InstanceMask> detections = {
        {RectMask(ChairAt(60)), "chair", 0.9}};
    if (i % 3 != 2) detections.push_back({scene.Truth(2), "person", 0.9});
    Split(scene, detections);
    EXPECT_EQ(Count("ignored"), 1) << i;  // The chair.
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
}

TEST_F(MovingObjectsTest, WhatComesIntoViewBeforeAMappedWallHasNotMoved) {
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene = ChairThatComesIntoView(i);
    Split(scene, {{scene.Truth(1), "chair", 0.9}}, WallFromTheRight(i));
    EXPECT_EQ(cv::countNonZero(last_.labels), 0) << i;
  }
  EXPECT_TRUE(splitter_.tracks().empty());
}

TEST_F(MovingObjectsTest, WhatNobodyDetectsIsNoBackgroundIfItCameLater) {
  const auto share_left_alone = [&](int frame, int x) {
    LayeredScene scene(3.0, frame);
    scene.Add(ChairAt(x), 2.0, 1);
    Split(scene, {}, WallAlone());
    EXPECT_EQ(cv::countNonZero(last_.labels), 0) << frame;
    return cv::countNonZero(last_.uncertain & scene.Truth(1)) /
           double(cv::countNonZero(scene.Truth(1)));
  };
  for (int i = 0; i < 12; ++i) share_left_alone(i, /*x=*/200);
  for (int i = 12; i < 30; ++i) {
    EXPECT_GT(share_left_alone(i, 4 * i), 0.8) << i;
  }
}

TEST_F(MovingObjectsTest, WhatNobodyDetectsIsBackgroundIfItComesIntoView) {
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene = ChairThatComesIntoView(i);
    Split(scene, {}, WallFromTheRight(i));
    EXPECT_EQ(cv::countNonZero(last_.uncertain & scene.Truth(1)), 0) << i;
  }
}

TEST_F(MovingObjectsTest, AWrongPoseMovesNothing) {
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene(i < 15 ? 3.0 : 2.4, i);
    scene.Add(ChairAt(60), i < 15 ? 2.0 : 1.4, 1);
    SurfacePrediction prediction = WallAlone();
    prediction.depth.setTo(2.0, RectMask(ChairAt(60)));
    prediction.background.setTo(2.0, RectMask(ChairAt(60)));
    Split(scene, {{scene.Truth(1), "chair", 0.9}}, prediction);
  }
  EXPECT_TRUE(splitter_.tracks().empty());
}

TEST_F(MovingObjectsTest, HalfOfTheRoomIsNotAnObject) {
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene(3.0, i);
    const cv::Rect bed(i < 15 ? 160 : 5, 5, 150, 110);
    scene.Add(bed, 2.0, 1);
    std::vector<InstanceMask> detections;
    if (i >= 15) detections.push_back({scene.Truth(1), "bed", 0.9});
    Split(scene, detections, WallAlone());
  }
  EXPECT_TRUE(splitter_.tracks().empty());
}

class SeenSpaceTest : public testing::Test {
 protected:
  /// Share of a card at `depth` metres in a view of pose `pose` that stands
  /// where space was empty.
  double EmptyShare(double depth, const Rigid3d& pose) const {
    const cv::Mat_<float> image(120, 160, static_cast<float>(depth));
    const cv::Mat_<uchar> card = RectMask({60, 40, 40, 40});
    const cv::Mat_<uchar> empty =
        space_.WasEmpty(card, ComputePointMap(image, SceneCamera()), pose);
    return double(cv::countNonZero(empty)) / cv::countNonZero(card);
  }
  const cv::Mat wall_ = cv::Mat_<float>(120, 160, 3.0f);
  const Rigid3d here_ = Rigid3d::Identity();
  SeenSpace space_{SceneCamera()};
};

TEST_F(SeenSpaceTest, IsWhatLiesClearlyBeforeWhatWasMeasured) {
  EXPECT_EQ(EmptyShare(2.0, here_), 0);
  space_.Add(0, wall_, here_);
  EXPECT_EQ(EmptyShare(2.0, here_), 1);
  EXPECT_EQ(EmptyShare(2.95, here_), 0);
  EXPECT_EQ(EmptyShare(4.0, here_), 0);
}

TEST_F(SeenSpaceTest, EndsAtTheBordersOfTheView) {
  space_.Add(0, wall_, here_);
  Rigid3d aside = here_;
  aside.translation().x() = 3;
  EXPECT_EQ(EmptyShare(2.0, aside), 0);
  Rigid3d behind = here_;
  behind.linear() =
      Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_EQ(EmptyShare(2.0, behind), 0);
  Rigid3d back = here_;
  back.translation().z() = -1;  // The card is 1 m before the old view.
  EXPECT_EQ(EmptyShare(2.0, back), 1);
}

TEST_F(SeenSpaceTest, IsUnknownWithoutDepth) {
  space_.Add(0, cv::Mat::zeros(120, 160, CV_32FC1), here_);
  EXPECT_EQ(EmptyShare(2.0, here_), 0);
}

TEST_F(SeenSpaceTest, IsUnknownWithinTwoPixelsOfWhatHidesIt) {
  // A pole before the wall; then a card behind the pole's place.
  const cv::Rect pole(75, 0, 10, 120);
  cv::Mat with_pole = wall_.clone();
  with_pole(pole) = 2.0;
  space_.Add(0, with_pole, here_);
  const cv::Mat_<float> image(120, 160, 2.4f);
  const cv::Rect card(60, 40, 40, 40);
  const cv::Mat_<uchar> empty = space_.WasEmpty(
      RectMask(card), ComputePointMap(image, SceneCamera()), here_);
  cv::Mat_<uchar> expected = RectMask(card);
  expected(cv::Rect(pole.x - 2, 0, pole.width + 4, 120)) = 0;
  EXPECT_EQ(cv::countNonZero(empty != expected), 0);
}

TEST_F(SeenSpaceTest, TheFirstAndTheLastFramesAreRemembered) {
  const cv::Mat card = cv::Mat_<float>(120, 160, 2.0f);
  space_.Add(0, wall_, here_);
  for (int i = 1; i < 1000; ++i) space_.Add(i, card, here_);
  EXPECT_EQ(EmptyShare(2.5, here_), 1);
  SeenSpace late(SceneCamera());
  for (int i = 0; i < 1000; ++i) late.Add(i, i < 980 ? card : wall_, here_);
  space_ = late;
  EXPECT_EQ(EmptyShare(2.5, here_), 1);
}

}  // namespace
}  // namespace splitfusion
