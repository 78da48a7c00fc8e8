#include "splitfusion/lib/split/hidden_instances.h"

#include <gtest/gtest.h>

#include "split/layered_scene.h"

namespace splitfusion {
namespace {

/// Somebody (surface 1) who was seen before, and now comes out where nobody
/// was predicted.
class RecognizeHiddenTest : public testing::Test {
 protected:
  RecognizeHiddenTest() {
    scene_.Add({60, 30, 30, 60}, 2.0, 1).Add({110, 30, 30, 60}, 2.0, 2);
    frame_ = scene_.MakeFrame(0);
    points_ = ComputePointMap(frame_.depth, SceneCamera());
    registry_.Create(0, "person", SurfaceKind::kNonRigid);
    registry_.RecordAppearance(
        1, ComputeAppearance(frame_.color, points_, scene_.Truth(1)));
    prediction_.labels = LabelImage::zeros(frame_.depth.size());
    prediction_.depth = cv::Mat_<float>::zeros(frame_.depth.size());
  }

  /// Surface that the detection of a card is matched to.
  int Recognized(int card, const std::string& class_name = "person",
                 Trust trust = Trust::kFull, int matched = 0) {
    SplitWork work{frame_, points_, {}, {}, {}, {}, {}, {}, {}};
    work.compared = CompareDepth(frame_.depth, prediction_, PriorOptions());
    const std::vector<Candidate> candidates = {
        {scene_.Truth(card), trust, class_name}, {scene_.Truth(1)}};
    std::vector<Match> matches(2);
    matches[1].surface = matched > 0 ? matched : -1;
    RecognizeHidden(candidates, LabelTable(), registry_, work, &matches);
    return matches[0].surface;
  }

  LayeredScene scene_;
  Frame frame_;
  PointMap points_;
  InstanceRegistry registry_;
  SurfacePrediction prediction_;
};

TEST_F(RecognizeHiddenTest, KnowsWhoComesOutByHisLooks) {
  EXPECT_EQ(Recognized(1), 1);
  EXPECT_EQ(Recognized(2), 0);
  EXPECT_EQ(Recognized(1, "chair"), 0);
  EXPECT_EQ(Recognized(1, "person", Trust::kMatched), 0);
}

TEST_F(RecognizeHiddenTest, WhoIsSeenOrMatchedIsNotHidden) {
  EXPECT_EQ(Recognized(1, "person", Trust::kFull, 1), 0);
  prediction_.labels.setTo(1, scene_.Truth(1));
  frame_.depth.copyTo(prediction_.depth);
  EXPECT_EQ(Recognized(1), 0);
}

TEST_F(RecognizeHiddenTest, WhoIsDormantIsNotLookedForHere) {
  registry_.SetDormant(1);
  EXPECT_EQ(Recognized(1), 0);
}

}  // namespace
}  // namespace splitfusion
