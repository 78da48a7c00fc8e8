#include "splitfusion/lib/association/lost_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

constexpr std::uint16_t kLimb = 3;

/// A strip of a wall that has moved sideways by more than its width, seen at
/// columns 100 to 119; the model has it at columns 70 to 89.
class LostPartsTest : public ::testing::Test {
 protected:
  LostPartsTest()
      : live_(MakeLiveView(camera_, WallDepth(camera_, 1.2),
                           PlainColor(camera_, {1, 2, 3}))) {
    live_.labels.colRange(100, 120).setTo(kLimb);
    AddSamples(70, 90);
  }

  void AddSamples(int begin, int end) {
    for (int v = 20; v < 100; v += 2) {
      for (int u = begin; u < end; u += 2) {
        ModelSample sample;
        sample.point = camera_.BackProject<float>(u, v, 1.2f);
        sample.normal = {0, 0, -1};
        sample.u = u, sample.v = v;
        sample.skinning.count = 1;
        sample.skinning.weights[0] = 1;
        samples_.push_back(sample);
      }
    }
  }

  Association Run(int stride = 2) const {
    return BuiltinAssociations()
        .Make(association_, live_, kLimb)
        ->Associate(samples_, WarpField(graph_), stride, gates_);
  }

  const PinholeCamera camera_ = SmallCamera();
  LiveView live_;
  std::vector<ModelSample> samples_;
  DeformationGraph graph_ = MakeRigidGraph(Rigid3d::Identity());
  AssociationGates gates_ = {0.05, 0.7, 1.31, false, 0.4};
  std::string association_ = "projective";
};

TEST_F(LostPartsTest, APartBesideItselfIsPairedWithTheNearestOfTheModel) {
  const Association association = Run();
  EXPECT_EQ(association.counts.accepted, 0);
  ASSERT_GT(association.lost.size(), 300u);
  for (const Correspondence& pair : association.lost) {
    EXPECT_EQ(pair.model.u, 88) << "the side of the strip that is nearest";
    const Eigen::Vector2f pixel = camera_.Project(pair.target);
    EXPECT_GE(pixel.x(), 99);
    EXPECT_LT(pixel.x(), 120);
    EXPECT_LT((pair.target - pair.model.point).norm(), gates_.lost_distance);
    EXPECT_EQ(pair.weight, DepthNoise().Confidence(pair.target.z()));
  }
}

TEST_F(LostPartsTest, IsAskedForAndBoundedByItsDistance) {
  gates_.lost_distance = 0.15;
  const std::size_t near = Run().lost.size();
  EXPECT_GT(near, 50u);
  gates_.lost_distance = 0.4;
  EXPECT_GT(Run().lost.size(), near + 100);
  gates_.lost_distance = 0.05;  // Less than between the strips.
  EXPECT_TRUE(Run().lost.empty());
  gates_.lost_distance = 0;
  EXPECT_TRUE(Run().lost.empty());
}

TEST_F(LostPartsTest, WhatHasAModelPullsNothing) {
  AddSamples(98, 122);
  const Association association = Run();
  EXPECT_GT(association.counts.accepted, 300);
  ASSERT_FALSE(association.lost.empty());
  for (const Correspondence& pair : association.lost) {
    // Above and below what the samples cover.
    const float row = camera_.Project(pair.target).y();
    EXPECT_TRUE(row < 20 || row > 99) << row;
  }
}

TEST_F(LostPartsTest, NormalsHaveToAgree) {
  for (ModelSample& sample : samples_) sample.normal = {1, 0, 0};
  EXPECT_TRUE(Run().lost.empty());
}

TEST_F(LostPartsTest, AHiddenPartIsNotAstray) {
  live_ = MakeLiveView(camera_, WallDepth(camera_, 1.2),
                       PlainColor(camera_, {1, 2, 3}));
  live_.labels.colRange(100, 120).setTo(kLimb);
  live_.depth.colRange(0, 100).setTo(0.8f);  // Something before it.
  EXPECT_TRUE(Run().lost.empty());
}

TEST_F(LostPartsTest, UncertainPixelsPullNothing) {
  live_.uncertain.colRange(100, 120).setTo(255);
  EXPECT_TRUE(Run().lost.empty());
}

TEST_F(LostPartsTest, GrazingDepthPullsNothing) {
  EXPECT_FALSE(Run().lost.empty());
  constexpr double kAngle = 0.2;
  gates_.grazing_angle = kAngle;
  const std::vector<Correspondence> seen = Run().lost;
  EXPECT_FALSE(seen.empty());
  for (const Correspondence& pair : seen) {
    EXPECT_GE(-pair.target_normal.dot(pair.target.normalized()),
              std::cos(kAngle) - 1e-5);
  }
  gates_.grazing_angle = 0.02;
  EXPECT_TRUE(Run().lost.empty());
}

TEST_F(LostPartsTest, TheClosestPointDoesNotKnowWhatIsHidden) {
  association_ = "closest_point";
  EXPECT_TRUE(Run().lost.empty());
}

}  // namespace
}  // namespace splitfusion
