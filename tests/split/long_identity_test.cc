// Surfaces keep their ids through what detectors and people do.

#include "split/splitter_fixture.h"

namespace splitfusion {
namespace {

constexpr double kNear = 1.5;  // Metres.
constexpr double kFar = 2.2;   // Metres.

class LongIdentityTest : public SplitterTest {
 protected:
  /// A frame with a near and a far person at these columns, each detected if
  /// enough of it is seen and `detector` finds it.
  void Step(int near_x, int far_x, bool found = true) {
    LayeredScene scene(3.0, next_frame_);
    scene.Add({near_x, 15, 50, 100}, kNear, 1);
    scene.Add({far_x, 30, 34, 75}, kFar, 2);
    std::vector<InstanceMask> detections;
    for (const int id : {1, 2}) {
      truth_[id - 1] = scene.Truth(id);
      if (found && cv::countNonZero(truth_[id - 1]) > 300) {
        detections.push_back({truth_[id - 1], "person", 0.9});
      }
    }
    Split(scene, detections);
  }
  void ExpectSeen(int id, double iou = 0.9) const {
    const cv::Mat_<uchar>& truth = truth_[id - 1];
    if (cv::countNonZero(truth) < 600) return;
    EXPECT_GT(IouOf(id, truth), iou) << "frame " << next_frame_ - 1;
  }
  void ExpectBothFollowed() const {
    ExpectSeen(1);
    ExpectSeen(2);
    EXPECT_EQ(splitter_.tracks().size(), 2u);
    EXPECT_EQ(cv::countNonZero(last_.labels > 2), 0);
  }
  cv::Mat_<uchar> truth_[2];
};

TEST_F(LongIdentityTest, WhoIsBehindAnotherFor30FramesComesOutAsHimself) {
  for (int i = 0; i < 14; ++i) {
    Step(60, 110 - 3 * i);
    ExpectBothFollowed();
  }
  for (int i = 0; i < 30; ++i) {  // All of him is covered.
    Step(60, 68);
    ASSERT_EQ(cv::countNonZero(truth_[1]), 0);
    ExpectBothFollowed();
  }
  for (int i = 0; i < 22; ++i) {  // On the side that he walked to.
    Step(60, 68 - 3 * i);
    ExpectSeen(1);
    if (i >= 14) ExpectBothFollowed();
  }
  EXPECT_TRUE(splitter_.tracks().at(2).followed());
}

TEST_F(LongIdentityTest, WhoTurnsBackBehindAnotherIsHimselfToo) {
  for (int i = 0; i < 14; ++i) Step(60, 110 - 3 * i);
  for (int i = 0; i < 30; ++i) Step(60, 68);
  for (int i = 0; i < 22; ++i) Step(60, 68 + 3 * i);
  ExpectBothFollowed();
}

TEST_F(LongIdentityTest, TheNearOneWalksPastTheFarOneWithMissedDetections) {
  for (int i = 0; i < 60; ++i) {
    Step(2 * i - 10, 64, /*found=*/i % 7 < 4);
    if (i > 4) ExpectSeen(1, 0.85);
  }
  ExpectBothFollowed();
}

TEST_F(LongIdentityTest, BothLeaveAndComeBackAfterALongTime) {
  for (int i = 0; i < 10; ++i) Step(20, 110);
  for (int i = 0; i < 14; ++i) Step(20 - 6 * i, 110 + 6 * i);
  for (int i = 0; i < 60; ++i) Step(-60, 170);
  EXPECT_FALSE(splitter_.tracks().at(1).followed());
  EXPECT_FALSE(splitter_.tracks().at(2).followed());
  for (int i = 0; i < 14; ++i) Step(-64 + 6 * i, 194 - 6 * i);
  for (int i = 0; i < 5; ++i) Step(20, 110);
  ExpectBothFollowed();
}

TEST_F(LongIdentityTest, FifteenFramesWithoutAnyDetectionAreBridged) {
  int x = 10;
  for (int i = 0; i < 60; ++i) {
    if (i < 38) ++x;
    Step(x, 120, /*found=*/i < 5 || i % 16 == 0);
    ExpectBothFollowed();
  }
  EXPECT_TRUE(splitter_.tracks().at(1).followed());
}

TEST_F(LongIdentityTest, TheClassFlickersTheSurfacesDoNot) {
  const std::string classes[] = {"person", "teddy bear", "person", "dog"};
  for (int i = 0; i < 40; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add({40 + i, 15, 50, 100}, kNear, 1).Add({5, 30, 34, 75}, kFar, 2);
    std::vector<InstanceMask> detections = {
        {scene.Truth(1), classes[i % 4], 0.9 - 0.1 * (i % 4)},
        {scene.Truth(2), classes[(i + 2) % 4], 0.7}};
    if (i % 5 == 4) {  // The same thing under two classes.
      detections.push_back({scene.Truth(1), "teddy bear", 0.6});
    }
    Split(scene, detections);
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.95) << i;
    EXPECT_GT(IouOf(2, scene.Truth(2)), 0.95) << i;
    EXPECT_EQ(splitter_.tracks().size(), 2u);
  }
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
}

TEST_F(LongIdentityTest, SpuriousDetectionsLeaveNoSurface) {
  cv::RNG random(3);
  for (int i = 0; i < 80; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add({60, 15, 50, 100}, kNear, 1);
    std::vector<InstanceMask> detections = {{scene.Truth(1), "person", 0.9}};
    // Every third frame, somewhere, as sure as can be.
    const cv::Rect ghost(random.uniform(0, 120), random.uniform(0, 80), 35, 40);
    if (i % 3 == 2) detections.push_back({RectMask(ghost), "dog", 0.95});
    // Always at one place, but weak; or a thing of the room.
    detections.push_back({RectMask({5, 60, 35, 40}), "cat", 0.3});
    detections.push_back({RectMask({115, 60, 40, 40}), "couch", 0.9});
    Split(scene, detections);
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.9) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
}

}  // namespace
}  // namespace splitfusion
