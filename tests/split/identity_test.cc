#include <gtest/gtest.h>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/birth_queue.h"
#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/mask_support.h"
#include "splitfusion/lib/split/surface_contact.h"

namespace splitfusion {
namespace {

TEST(BirthQueue, CountsDetectionsAtOnePlace) {
  BirthQueue queue(/*window=*/4);
  const cv::Mat_<uchar> here = RectMask({10, 10, 30, 30});
  const cv::Mat_<uchar> there = RectMask({100, 10, 30, 30});
  EXPECT_EQ(queue.Add(0, here), 1);
  EXPECT_EQ(queue.Add(1, there), 1);
  EXPECT_EQ(queue.Add(2, Moved(here, 5, 0)), 2);
  EXPECT_EQ(queue.Add(2, Moved(here, 6, 0)), 2);  // The same frame.
  EXPECT_EQ(queue.Add(3, Moved(here, 10, 0)), 3);
}

TEST(BirthQueue, ForgetsAfterTheWindowAndAfterBirth) {
  BirthQueue queue(/*window=*/4);
  const cv::Mat_<uchar> here = RectMask({10, 10, 30, 30});
  queue.Add(0, here);
  EXPECT_EQ(queue.Add(3, here), 2);
  EXPECT_EQ(queue.Add(4, here), 2);
  EXPECT_EQ(queue.Add(9, here), 1);
  queue.Remove(here);
  EXPECT_EQ(queue.Add(10, here), 1);
}

TEST(MaskSupport, RisesWhereDetectionsCoverASurface) {
  MaskSupport support;
  const cv::Mat_<uchar> body = RectMask({40, 30, 60, 60});
  const cv::Mat_<uchar> mask = RectMask({40, 30, 30, 60});
  LabelImage labels(120, 160, std::uint16_t(0));
  labels.setTo(1, body);
  EXPECT_FLOAT_EQ(support.Predict(1, labels)(50, 50), 0.5f);
  for (int i = 0; i < 8; ++i) support.Update(1, body, mask, labels);
  const cv::Mat_<float> after = support.Predict(1, labels);
  EXPECT_GT(after(60, 50), 0.9f);
  EXPECT_LT(after(60, 90), 0.1f);
}

TEST(MaskSupport, MovesWithTheSurface) {
  MaskSupport support;
  const cv::Mat_<uchar> body = RectMask({20, 30, 60, 60});
  LabelImage labels(120, 160, std::uint16_t(0));
  labels.setTo(1, body);
  for (int i = 0; i < 8; ++i) {
    support.Update(1, body, RectMask({20, 30, 30, 60}), labels);
  }
  LabelImage moved(120, 160, std::uint16_t(0));
  moved.setTo(1, Moved(body, 40, 0));
  const cv::Mat_<float> after = support.Predict(1, moved);
  EXPECT_GT(after(60, 70), 0.9f);
  EXPECT_LT(after(60, 110), 0.1f);
}

class ContactTest : public testing::Test {
 protected:
  double Share(double left_depth, double right_depth) const {
    LayeredScene scene;
    scene.Add(left_, left_depth, 1).Add(right_, right_depth, 2);
    const Frame frame = scene.MakeFrame(0);
    return ContactShare(ComputePointMap(frame.depth, SceneCamera()),
                        RectMask(left_), RectMask(right_));
  }
  const cv::Rect left_{40, 30, 30, 60};
  const cv::Rect right_{70, 30, 30, 60};
};

TEST_F(ContactTest, IsTheSharedSideOfOneSurface) {
  EXPECT_NEAR(Share(2.0, 2.0), 60.0 / 176, 0.05);
}

TEST_F(ContactTest, IsZeroAcrossADepthGap) {
  EXPECT_EQ(Share(2.0, 2.4), 0.0);
  EXPECT_EQ(Share(2.4, 2.0), 0.0);
}

TEST(InstanceRegistry, TakesTheClassOfTheMajority) {
  InstanceRegistry registry;
  const int id = registry.Create(0, "dog", SurfaceKind::kNonRigid);
  registry.RecordDetection(id, 0, "dog", 0.9);
  registry.RecordDetection(id, 1, "person", 0.6);
  EXPECT_EQ(registry.at(id).class_name, "dog");
  registry.RecordDetection(id, 2, "person", 0.6);
  EXPECT_EQ(registry.at(id).class_name, "person");
  EXPECT_EQ(registry.at(id).last_detected_frame, 2);
}

TEST(InstanceRegistry, NeverUsesAnIdTwice) {
  InstanceRegistry registry;
  EXPECT_EQ(registry.Create(0, "dog", SurfaceKind::kNonRigid), 1);
  EXPECT_EQ(registry.Create(0, "dog", SurfaceKind::kNonRigid), 2);
  registry.Merge(2, 1);
  EXPECT_EQ(registry.Matchable(), std::set<int>{1});
  EXPECT_EQ(registry.Create(5, "dog", SurfaceKind::kNonRigid), 3);
  registry.SetDormant(1);
  EXPECT_EQ(registry.Matchable(), (std::set<int>{1, 3}));
  EXPECT_EQ(registry.Followed(), std::set<int>{3});
}

TEST(InstanceRegistry, RecognisesWhoComesBack) {
  LayeredScene scene;
  scene.Add({20, 30, 30, 60}, 2.0, 1).Add({100, 30, 30, 60}, 2.0, 2);
  const Frame frame = scene.MakeFrame(0);
  const PointMap points = ComputePointMap(frame.depth, SceneCamera());
  const auto looks = [&](int card) {
    return ComputeAppearance(frame.color, points, scene.Truth(card));
  };
  InstanceRegistry registry;
  const int id = registry.Create(0, "person", SurfaceKind::kNonRigid);
  registry.RecordAppearance(id, looks(1));
  const auto alike = [&](const Appearance& appearance, SurfaceKind kind) {
    return registry.FindAlike(appearance, kind, registry.Dormant(), 1);
  };
  EXPECT_EQ(alike(looks(1), SurfaceKind::kNonRigid), 0);
  registry.SetDormant(id);
  EXPECT_EQ(alike(looks(1), SurfaceKind::kNonRigid), id);
  EXPECT_EQ(alike(looks(2), SurfaceKind::kNonRigid), 0);
  EXPECT_EQ(alike(looks(1), SurfaceKind::kRigid), 0);
  Appearance far_away = looks(1);
  far_away.center[2] += 1.5f;
  EXPECT_EQ(alike(far_away, SurfaceKind::kNonRigid), 0);
  EXPECT_EQ(registry.FindAlike(far_away, SurfaceKind::kNonRigid, {id}, 30), id)
      << "after a second one may be there";
  EXPECT_EQ(registry.FindAlike(looks(1), SurfaceKind::kNonRigid, {}, 1), 0);
}

}  // namespace
}  // namespace splitfusion
