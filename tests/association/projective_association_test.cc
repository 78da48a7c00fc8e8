#include <gtest/gtest.h>

#include <random>

#include "splitfusion/lib/association/association.h"
#include "support/expect_input_error.h"
#include "support/rejected.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

/// A wall at 1.2 m, and model points on it at every fourth pixel.
class AssociationTest : public ::testing::Test {
 protected:
  AssociationTest() : live_(View(WallDepth(camera_, 1.2))) {
    for (int v = 8; v < 112; v += 4) {
      for (int u = 8; u < 152; u += 4) {
        samples_.push_back(Sample(u, v, 1.2f));
      }
    }
  }

  LiveView View(const cv::Mat_<float>& depth) const {
    return MakeLiveView(camera_, depth, PlainColor(camera_, {1, 2, 3}));
  }

  ModelSample Sample(int u, int v, float depth) const {
    ModelSample sample;
    sample.point = camera_.BackProject<float>(u, v, depth);
    sample.normal = {0, 0, -1};
    sample.u = u, sample.v = v;
    sample.skinning.count = 1;
    sample.skinning.weights[0] = 1;
    return sample;
  }

  Association Run(int surface = 0, int stride = 1) const {
    const Association association =
        BuiltinAssociations()
            .Make("projective", live_, static_cast<std::uint16_t>(surface))
            ->Associate(samples_, WarpField(graph_), stride, gates_);
    const AssociationCounts& counts = association.counts;
    EXPECT_EQ(counts.accepted + Rejected(counts), counts.model_points);
    EXPECT_EQ(association.correspondences.size(),
              static_cast<std::size_t>(counts.accepted));
    return association;
  }

  int all() const { return static_cast<int>(samples_.size()); }

  const PinholeCamera camera_ = SmallCamera();
  LiveView live_;
  std::vector<ModelSample> samples_;
  DeformationGraph graph_ = MakeRigidGraph(Rigid3d::Identity());
  AssociationGates gates_ = {0.10, 0.52, 1.31, false};
};

TEST_F(AssociationTest, AModelOnTheLiveSurfaceIsAccepted) {
  const Association association = Run();
  EXPECT_EQ(association.counts.model_points, all());
  EXPECT_EQ(association.counts.accepted, all());
  for (const Correspondence& c : association.correspondences) {
    EXPECT_LT((c.target - c.model.point).norm(), 1e-5);
    EXPECT_LT((c.target_normal - c.warped_normal).norm(), 1e-3);
    EXPECT_EQ(c.weight, DepthNoise().Confidence(c.target.z()));
  }
}

TEST_F(AssociationTest, TheWarpIsAppliedFirst) {
  const Rigid3d motion = MakeMotion({0.1, 0.05, 0}, {0.02, 0.01, 0.03});
  for (ModelSample& sample : samples_) {
    sample.point = motion.inverse().cast<float>() * sample.point;
    sample.normal = motion.inverse().linear().cast<float>() * sample.normal;
  }
  graph_ = MakeRigidGraph(motion);
  const Association association = Run();
  EXPECT_EQ(association.counts.accepted, all());
  EXPECT_LT(association.correspondences[0].warped_normal.x(), 1e-5);
}

TEST_F(AssociationTest, OutsideTheImage) {
  samples_ = {Sample(200, 60, 1.2f), Sample(-9, 60, 1.2f),
              Sample(80, 130, 1.2f), Sample(80, 60, 1.2f)};
  samples_[3].point.z() = -1.2f;  // Behind the camera.
  EXPECT_EQ(Rejected(Run().counts, "outside_image"), 4);
}

TEST_F(AssociationTest, NoDepth) {
  cv::Mat_<float> depth = WallDepth(camera_, 1.2);
  depth.colRange(0, 80).setTo(0);
  live_ = View(depth);
  const AssociationCounts counts = Run().counts;
  EXPECT_GE(Rejected(counts, "no_depth"), all() / 2);
  EXPECT_EQ(Rejected(counts, "no_depth") + counts.accepted, all());
}

TEST_F(AssociationTest, OtherSurface) {
  EXPECT_EQ(Rejected(Run(/*surface=*/3).counts, "other_surface"), all());
  live_.labels.colRange(0, 80).setTo(3);
  const AssociationCounts counts = Run(/*surface=*/3).counts;
  EXPECT_EQ(counts.accepted, all() / 2);
  EXPECT_EQ(Rejected(counts, "other_surface"), all() / 2);
  live_.uncertain.setTo(255);
  EXPECT_EQ(Rejected(Run(/*surface=*/3).counts, "other_surface"), all());
}

TEST_F(AssociationTest, WhatAnotherSurfaceHidesIsToldFromWhatLiesBeforeIt) {
  cv::Mat_<float> depth = WallDepth(camera_, 1.2);
  depth.colRange(0, 80).setTo(0.9f);    // Nearer than the model.
  depth.colRange(80, 160).setTo(1.5f);  // Farther.
  live_ = View(depth);
  const AssociationCounts counts = Run(/*surface=*/3).counts;
  EXPECT_EQ(Rejected(counts, "occluded"), all() / 2);
  EXPECT_EQ(Rejected(counts, "other_surface"), all() / 2);
}

TEST_F(AssociationTest, DepthEdge) {
  cv::Mat_<float> depth = WallDepth(camera_, 1.2);
  depth.colRange(0, 80).setTo(0.8f);
  live_ = View(depth);
  samples_ = {Sample(80, 60, 1.2f), Sample(79, 60, 0.8f),
              Sample(100, 60, 1.2f)};
  const AssociationCounts counts = Run().counts;
  EXPECT_EQ(Rejected(counts, "depth_edge"), 2);
  EXPECT_EQ(counts.accepted, 1);
}

TEST_F(AssociationTest, Distance) {
  gates_.distance = 0.05;
  samples_ = {Sample(80, 60, 1.16f), Sample(80, 60, 1.24f),
              Sample(80, 60, 1.1f), Sample(80, 60, 1.3f)};
  const AssociationCounts counts = Run().counts;
  EXPECT_EQ(counts.accepted, 2);
  EXPECT_EQ(Rejected(counts, "distance"), 2);
}

TEST_F(AssociationTest, TheDistanceGateOpensWithTheNoiseOfDepth) {
  live_ = View(WallDepth(camera_, 4));
  gates_.distance = 0.01;
  samples_ = {Sample(80, 60, 4.f + 2 * DepthNoise().Sigma(4.f)),
              Sample(80, 60, 4.f + 4 * DepthNoise().Sigma(4.f))};
  const AssociationCounts counts = Run().counts;
  EXPECT_EQ(counts.accepted, 1);
  EXPECT_EQ(Rejected(counts, "distance"), 1);
}

TEST_F(AssociationTest, NormalAngle) {
  gates_.normal_angle = 0.5;
  samples_ = {Sample(80, 60, 1.2f), Sample(80, 60, 1.2f), Sample(80, 60, 1.2f)};
  samples_[1].normal = {std::sin(0.4f), 0, -std::cos(0.4f)};
  samples_[2].normal = {std::sin(0.6f), 0, -std::cos(0.6f)};
  const AssociationCounts counts = Run().counts;
  EXPECT_EQ(counts.accepted, 2);
  EXPECT_EQ(Rejected(counts, "normal_angle"), 1);
}

TEST_F(AssociationTest, Grazing) {
  // A wall turned by 0.5: rays from the right meet it more flatly.
  const Eigen::Vector3d normal(std::sin(0.5), 0, std::cos(0.5));
  live_ = View(PlaneDepth(camera_, normal, 1.2 * std::cos(0.5)));
  samples_.clear();
  for (const int u : {40, 120}) {
    samples_.push_back(Sample(u, 60, live_.depth(60, u)));
    samples_.back().normal = -normal.cast<float>();
  }
  gates_.grazing_angle = 0.5;
  const AssociationCounts counts = Run().counts;
  EXPECT_EQ(Rejected(counts, "grazing"), 1);
  EXPECT_EQ(counts.accepted, 1);
}

TEST_F(AssociationTest, StrideKeepsEveryNthPixelOfTheRendering) {
  samples_ = {Sample(8, 8, 1.2f), Sample(12, 8, 1.2f), Sample(8, 12, 1.2f),
              Sample(16, 24, 1.2f)};
  EXPECT_EQ(Run(0, /*stride=*/8).counts.model_points, 2);
}

TEST_F(AssociationTest, EveryPointIsCountedOnceAndTheOrderIsKept) {
  cv::Mat_<float> depth = WallDepth(camera_, 1.2);
  depth(cv::Rect(20, 20, 60, 30)).setTo(0.9f);
  depth(cv::Rect(90, 60, 20, 20)).setTo(0);
  live_ = View(depth);
  live_.labels(cv::Rect(100, 0, 60, 40)).setTo(2);
  std::mt19937 random(3);
  samples_.clear();
  for (int i = 0; i < 5000; ++i) {
    samples_.push_back(Sample(static_cast<int>(random() % 200) - 20,
                              static_cast<int>(random() % 140) - 10,
                              0.9f + 0.001f * (random() % 400)));
    samples_.back().normal =
        Eigen::Vector3f(0.001f * (random() % 900), 0, -1).normalized();
  }
  const Association first = Run();
  for (const int count :
       {first.counts.accepted, Rejected(first.counts, "outside_image"),
        Rejected(first.counts, "no_depth"),
        Rejected(first.counts, "other_surface"),
        Rejected(first.counts, "depth_edge"),
        Rejected(first.counts, "distance"),
        Rejected(first.counts, "normal_angle")}) {
    EXPECT_GT(count, 0);
  }
  const Association second = Run();
  ASSERT_EQ(first.correspondences.size(), second.correspondences.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < first.correspondences.size(); ++i) {
    const Eigen::Vector3f& point = first.correspondences[i].model.point;
    EXPECT_EQ(point, second.correspondences[i].model.point);
    while (at < samples_.size() && samples_[at].point != point) ++at;
  }
  EXPECT_LT(at, samples_.size()) << "not in the order of the samples";
}

}  // namespace
}  // namespace splitfusion
