#include "splitfusion/lib/energy/residual_sink.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "splitfusion/lib/energy/ceres_blocks.h"
#include "splitfusion/lib/energy/warped_points.h"
#include "support/expect_input_error.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

/// Depth of the warped point over a plane z = target.
struct DepthError {
  static constexpr int kResiduals = 1;
  double target = 0;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    residual[0] = x[2] - T(target);
    return true;
  }
};

/// A constant residual vector of one node.
struct Constant {
  static constexpr int kResiduals = 2;
  double x = 0, y = 0;
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    residual[0] = T(x) + T(0) * twists[0][0];
    residual[1] = T(y);
    return true;
  }
};

ModelSample SampleAt(float z) {
  ModelSample sample;
  sample.point = {0, 0, z};
  sample.skinning.count = 1;
  sample.skinning.weights[0] = 1;
  return sample;
}

/// Energy of points that are so many metres off the plane z = 1.
double PointEnergy(const TermOptions& options,
                   const std::vector<double>& errors, double total = 0) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  std::vector<ModelSample> samples;
  std::vector<DepthError> functors;
  for (const double error : errors) {
    samples.push_back(SampleAt(1));
    functors.push_back({1 - error});
  }
  std::vector<const ModelSample*> pointers;
  for (const ModelSample& sample : samples) pointers.push_back(&sample);
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  sink.AddWarpedPoints(pointers, functors, total);
  EXPECT_EQ(sink.residual_vectors(), static_cast<int>(errors.size()));
  return EnergyOf(graph, sink.residuals());
}

TEST(ResidualSink, EnergyIsWeightTimesTheMeanInSquaredCentimetres) {
  // weight / N * sum |r|^2 / s^2 = 3 / 2 * (1 + 4).
  const TermOptions options{"", 3, LossKind::kTrivial, 0.01};
  EXPECT_NEAR(PointEnergy(options, {0.01, -0.02}), 7.5, 1e-9);
}

TEST(ResidualSink, LossesSeeCentimetresToo) {
  // Huber at 1 cm: 1 and 2 * 2 - 1 = 3.
  const TermOptions huber{"", 1, LossKind::kHuber, 0.01};
  EXPECT_NEAR(PointEnergy(huber, {0.01, -0.02}), 2, 1e-9);
  // Tukey at 2 cm is flat beyond: 4 / 3 in cm^2.
  const TermOptions tukey{"", 1, LossKind::kTukey, 0.02};
  EXPECT_NEAR(PointEnergy(tukey, {0.02, 0.5}), 4.0 / 3, 1e-9);
}

TEST(ResidualSink, AWeightMeansTheSameForAnyNumberOfPoints) {
  const TermOptions options{"", 2, LossKind::kCauchy, 0.01};
  const double once = PointEnergy(options, {0.01, 0.03});
  std::vector<double> many;
  for (int i = 0; i < 1000; ++i) many.insert(many.end(), {0.01, 0.03});
  EXPECT_NEAR(PointEnergy(options, many), once, 1e-9 * once);
}

TEST(ResidualSink, WeightsThatResidualsCarryAreNormalisedByTheirSum) {
  const TermOptions options{"", 2, LossKind::kHuber, 0.01};
  // Two of weight 1/4 each: the mean is that of two of weight 1.
  EXPECT_NEAR(PointEnergy(options, {0.005, 0.005}, 0.5),
              4 * PointEnergy(options, {0.005, 0.005}), 1e-9);
}

TEST(ResidualSink, NodeResidualsAreNormalisedAlike) {
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const TermOptions options{"", 6, LossKind::kHuber, 0.05};
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  // |(3, 4)| = 5 cm is an inlier still: 25; 10 cm: 2 * 5 * 10 - 25 = 75.
  sink.AddNodes({{0}, {0}}, std::vector<Constant>{{0.03, 0.04}, {0.06, 0.08}});
  EXPECT_EQ(sink.residual_vectors(), 2);
  EXPECT_NEAR(EnergyOf(graph, sink.residuals()), 6.0 / 2 * (25 + 75), 1e-9);
}

TEST(ResidualSink, PointsOfTheSameNodesShareABlock) {
  DeformationGraph graph;
  graph.positions = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  graph.motions.resize(3);
  std::vector<ModelSample> samples(1200, SampleAt(1));
  for (int i = 0; i < 1200; ++i) {
    Skinning& skinning = samples[i].skinning;
    skinning.count = 2;
    skinning.nodes = {i % 2, 2};
    skinning.weights = {0.5f, 0.5f};
  }
  std::vector<const ModelSample*> pointers;
  for (const ModelSample& sample : samples) pointers.push_back(&sample);
  WarpedPointsCache cache;
  const TermOptions options;
  ResidualSink sink(options, &cache);
  sink.AddWarpedPoints(pointers, std::vector<DepthError>(1200, {0.9}));
  // Two sets of 600 points, at most 512 in a block.
  const auto blocks = MakeCeresBlocks(graph, sink.residuals());
  ASSERT_EQ(blocks.size(), 4u);
  for (const ResidualBlock& block : blocks) EXPECT_EQ(block.nodes[1], 2);
  EXPECT_NEAR(EnergyOf(graph, sink.residuals()), 100, 1e-6);
  // Another term over the same samples takes the points as they are.
  ResidualSink other(options, &cache);
  other.AddWarpedPoints(pointers, std::vector<DepthError>(1200, {0.8}));
  EXPECT_EQ(other.residuals().points, sink.residuals().points);
  pointers.pop_back();
  EXPECT_NE(cache.Get(pointers), sink.residuals().points);
}

TEST(ResidualSink, NothingAddedIsNothing) {
  const TermOptions options;
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  sink.AddWarpedPoints({}, std::vector<DepthError>());
  sink.AddNodes({}, std::vector<Constant>());
  EXPECT_EQ(sink.residuals().points, nullptr);
  EXPECT_EQ(sink.residuals().of_nodes, nullptr);
  EXPECT_EQ(sink.residual_vectors(), 0);
}

TEST(ResidualSink, ATupleMustNotRepeatANode) {
  const TermOptions options;
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  ExpectInputError(
      [&] {
        sink.AddNodes({{0, 1}, {2, 2}}, std::vector<Constant>(2));
      },
      "nodes of a residual = 2 2: expected different nodes");
}

TEST(ResidualSink, NodesMustBeThoseOfTheGraph) {
  const TermOptions options;
  WarpedPointsCache cache(/*nodes=*/3);
  ResidualSink sink(options, &cache);
  const std::string expected = ": expected nodes of a graph of 3";
  const auto refused = [&](const std::vector<int>& tuple,
                           const std::string& text) {
    ExpectInputError(
        [&] {
          sink.AddNodes({{0, 2}, tuple}, std::vector<Constant>(2));
        },
        "nodes of a residual = " + text + expected);
  };
  refused({1, 3}, "1 3");
  refused({-1}, "-1");
  refused({}, "none");
}

TEST(ResidualSink, SamplesMustBeCarriedByNodesOfTheGraph) {
  const TermOptions options;
  WarpedPointsCache cache(/*nodes=*/3);
  ResidualSink sink(options, &cache);
  const auto refused = [&](int count, const std::vector<int>& nodes,
                           const std::string& message) {
    ModelSample sample = SampleAt(1);
    sample.skinning.count = count;
    std::copy(nodes.begin(), nodes.end(), sample.skinning.nodes.begin());
    ExpectInputError(
        [&] { sink.AddWarpedPoints({&sample}, std::vector<DepthError>(1)); },
        message);
  };
  refused(1, {3}, "nodes of a residual = 3: expected nodes of a graph of 3");
  refused(2, {-4, 1}, "nodes of a residual = -4 1: expected nodes of");
  refused(2, {2, 1}, "nodes of a sample = 2 1: expected ascending nodes");
  refused(0, {0}, "nodes of a sample = 0: expected 1..8");
  refused(9, {0}, "nodes of a sample = 9: expected 1..8");
  ExpectInputError(
      [&] { sink.AddWarpedPoints({nullptr}, std::vector<DepthError>(1)); },
      "sample of a residual = null: expected a sample");
}

TEST(ResidualSink, ThereIsAFunctorForEverything) {
  const TermOptions options;
  WarpedPointsCache cache;
  ResidualSink sink(options, &cache);
  const ModelSample sample = SampleAt(1);
  ExpectInputError(
      [&] { sink.AddWarpedPoints({&sample}, std::vector<DepthError>(2)); },
      "functors of residuals = 2: expected one for each of 1");
  ExpectInputError(
      [&] {
        sink.AddNodes({{0}, {1}}, std::vector<Constant>(1));
      },
      "functors of residuals = 1: expected one for each of 2");
}

TEST(ResidualSink, SamplesOfTheSameMemoryAreOthersIfTheyChange) {
  const TermOptions options;
  WarpedPointsCache cache;
  ModelSample sample = SampleAt(1);
  const auto points = cache.Get({&sample});
  EXPECT_EQ(cache.Get({&sample}), points);
  sample.point.x() = 0.5f;
  EXPECT_NE(cache.Get({&sample}), points);
  sample.point.x() = 0;
  EXPECT_EQ(cache.Get({&sample}), points);
  sample.skinning.nodes[0] = 1;
  EXPECT_NE(cache.Get({&sample}), points);
}

}  // namespace
}  // namespace splitfusion
