#include "splitfusion/lib/deformation/skinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "support/expect_input_error.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// Nodes on a line, at the given places, each tied to all others.
DeformationGraph NodesOnLine(const std::vector<double>& places) {
  DeformationGraph graph;
  const int count = static_cast<int>(places.size());
  graph.node_spacing = 0.1;
  graph.motions.resize(count);
  graph.neighbors.resize(count);
  for (int i = 0; i < count; ++i) {
    graph.positions.emplace_back(places[i], 0, 1);
    for (int j = 0; j < count; ++j) {
      if (j != i) graph.neighbors[i].push_back(j);
    }
  }
  return graph;
}

float WeightOf(const Skinning& skinning, int node) {
  for (int k = 0; k < skinning.count; ++k) {
    if (skinning.nodes[k] == node) return skinning.weights[k];
  }
  return 0;
}

float WeightSum(const Skinning& skinning) {
  return std::accumulate(skinning.weights.begin(), skinning.weights.end(), 0.f);
}

TEST(Skinning, WeightsAreThoseOfEquationThreeByHand) {
  // K = 2 of 4 nodes, at distances 1, 2, 4 and 8 from the point: d_max = 4,
  // (1 - 1/4)^2 = 9/16 and (1 - 2/4)^2 = 4/16, sum 13/16.
  const SkinningIndex index(NodesOnLine({1, -2, 4, -8}), 2);
  const Skinning skinning = index.Skin({0, 0, 1});
  ASSERT_EQ(skinning.count, 2);
  EXPECT_EQ(skinning.nodes[0], 0);
  EXPECT_EQ(skinning.nodes[1], 1);
  EXPECT_NEAR(skinning.weights[0], 9.0 / 13, 1e-6);
  EXPECT_NEAR(skinning.weights[1], 4.0 / 13, 1e-6);
}

TEST(Skinning, WithFewerNodesAllAreUsedWithTwiceTheFarthestDistance) {
  // d_max = 2 * 3: (1 - 1/6)^2 = 25/36, (1 - 3/6)^2 = 9/36.
  const SkinningIndex index(NodesOnLine({1, -3}), 6);
  const Skinning skinning = index.Skin({0, 0, 1});
  ASSERT_EQ(skinning.count, 2);
  EXPECT_NEAR(skinning.weights[0], 25.0 / 34, 1e-6);
  EXPECT_NEAR(skinning.weights[1], 9.0 / 34, 1e-6);
}

TEST(Skinning, OneNodeCarriesEverything) {
  const SkinningIndex index(MakeRigidGraph(Rigid3d::Identity()), 6);
  for (const float x : {0.f, 1.f, 100.f}) {
    const Skinning skinning = index.Skin({x, -x, x});
    ASSERT_EQ(skinning.count, 1);
    EXPECT_EQ(skinning.nodes[0], 0);
    EXPECT_EQ(skinning.weights[0], 1);
  }
}

TEST(Skinning, APointOnANodeAndEqualDistancesStayFinite) {
  const SkinningIndex on_node(NodesOnLine({0, 1, 2, 3}), 2);
  EXPECT_NEAR(WeightSum(on_node.Skin({0, 0, 1})), 1, 1e-6);
  EXPECT_GT(WeightOf(on_node.Skin({0, 0, 1}), 0), 0.7f);
  const SkinningIndex all_equal(NodesOnLine({1, 1, -1, -1}), 3);
  const Skinning skinning = all_equal.Skin({0, 0, 1});
  EXPECT_NEAR(WeightSum(skinning), 1, 1e-6);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(skinning.weights[k], 1.0 / 3, 1e-6);
}

TEST(Skinning, APointOnANodeWithoutEdgesIsCarriedByIt) {
  DeformationGraph graph;
  graph.positions = {{0, 0, 1}, {5, 0, 1}};
  graph.motions.resize(2);
  graph.neighbors.resize(2);
  const Skinning skinning = SkinningIndex(graph, 4).Skin({5, 0, 1});
  EXPECT_EQ(skinning.count, 1);
  EXPECT_EQ(skinning.nodes[0], 1);
  EXPECT_EQ(skinning.weights[0], 1.f);
}

TEST(Skinning, WeightsSumToOneAndNodesAscend) {
  const TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  const SkinningIndex index(CoverWithNodes(mesh, 0.04), 6);
  for (const Skinning& skinning : index.Skin(mesh.vertices)) {
    ASSERT_EQ(skinning.count, 6);
    EXPECT_NEAR(WeightSum(skinning), 1, 1e-5);
    EXPECT_TRUE(std::is_sorted(skinning.nodes.begin(),
                               skinning.nodes.begin() + skinning.count));
    for (int k = 0; k < 6; ++k) EXPECT_GE(skinning.weights[k], 0);
  }
}

TEST(Skinning, NodesAreTheNearestOnes) {
  const TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const SkinningIndex index(graph, 6);
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 7) {
    std::vector<std::pair<double, int>> order;
    for (int n = 0; n < graph.size(); ++n) {
      const Eigen::Vector3d v = mesh.vertices[i].cast<double>();
      order.emplace_back((graph.positions[n] - v).norm(), n);
    }
    std::sort(order.begin(), order.end());
    const Skinning skinning = index.Skin(mesh.vertices[i]);
    for (int k = 0; k < skinning.count; ++k) {
      const double d =
          (graph.positions[skinning.nodes[k]] - mesh.vertices[i].cast<double>())
              .norm();
      EXPECT_LT(d, order[5].first + 1e-6);
    }
  }
}

TEST(Skinning, MotionIsContinuousWhenCrossingBetweenNodes) {
  const TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.01, 1);
  DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  Shake(0.03, /*seed=*/5, &graph);  // 3 cm and 2 degrees, neighbours apart.
  const SkinningIndex index(graph, 6);
  const WarpField warp(graph);
  constexpr float kStep = 1e-4f;
  Eigen::Vector3f last(0, 0, 0);
  for (int i = 0; i < 2500; ++i) {
    const Eigen::Vector3f p(0.02f + i * kStep, 0.07f + 0.3f * i * kStep, 1);
    const Eigen::Vector3f warped = warp.WarpPoint(index.Skin(p), p);
    // A jump of the weights would be of the size of the shake.
    if (i > 0) {
      EXPECT_LT((warped - last).norm(), 10 * kStep) << "at step " << i;
    }
    last = warped;
  }
}

TEST(Skinning, NodesOfThePlateBesideCarryNothing) {
  // An arm 3 cm beside the torso; nodes are 2.5 cm apart, as near the camera.
  constexpr double kLength = 0.4, kGap = 0.03;
  const TriangleMesh mesh = HairpinMesh(kLength, 0.2, kGap, 0.005);
  const DeformationGraph graph = CoverWithNodes(mesh, 0.025);
  const SkinningIndex index(graph, 6);
  int checked = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    if (v.x() > kLength - 0.12) continue;  // Near the joint they may.
    const bool arm = v.z() < 1 + kGap / 2;
    const Skinning skinning = index.Skin(v);
    for (int k = 0; k < skinning.count; ++k) {
      const Eigen::Vector3d& g = graph.positions[skinning.nodes[k]];
      EXPECT_EQ(g.z() < 1 + kGap / 2, arm) << v.transpose();
    }
    ++checked;
  }
  EXPECT_GT(checked, 4000);
}

TEST(Skinning, TheArmMovesWithoutTheTorso) {
  constexpr double kLength = 0.4, kGap = 0.03;
  const TriangleMesh mesh = HairpinMesh(kLength, 0.2, kGap, 0.005);
  DeformationGraph graph = CoverWithNodes(mesh, 0.025);
  for (int i = 0; i < graph.size(); ++i) {
    if (graph.positions[i].z() < 1 + kGap / 2) {
      graph.motions[i].translation = {0, 0, -0.2};  // The arm leaves.
    }
  }
  const SkinningIndex index(graph, 6);
  const WarpField warp(graph);
  for (const Eigen::Vector3f& v : mesh.vertices) {
    if (v.x() > kLength - 0.12) continue;
    const float moved = (warp.WarpPoint(index.Skin(v), v) - v).z();
    EXPECT_NEAR(moved, v.z() < 1 + kGap / 2 ? -0.2 : 0, 1e-5);
  }
}

TEST(Skinning, ManyEdgesStillGiveTheNearestNodes) {
  // Everybody tied to everybody: far more candidates than are needed.
  std::vector<double> places;
  for (int i = 0; i < 150; ++i) places.push_back(0.01 * i);
  const SkinningIndex index(NodesOnLine(places), 6);
  const Skinning skinning = index.Skin({1.4f, 0, 1});
  for (int k = 0; k < skinning.count; ++k) {
    EXPECT_NEAR(places[skinning.nodes[k]], 1.4, 0.04);
  }
}

TEST(Skinning, RefusesOtherK) {
  const DeformationGraph graph = NodesOnLine({0, 1});
  for (const int k : {0, -1, kMaxSkinningNodes + 1}) {
    ExpectInputError([&] { SkinningIndex(graph, k); },
                     "neighbors_per_point = " + std::to_string(k) +
                         ": expected 1.." + std::to_string(kMaxSkinningNodes));
  }
}

TEST(Skinning, OneByOneAndInParallelAreTheSame) {
  const TriangleMesh mesh = PlateMesh(0.3, 0.2, 0.005, 1);
  const SkinningIndex index(CoverWithNodes(mesh, 0.04), 6);
  const std::vector<Skinning> all = index.Skin(mesh.vertices);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Skinning one = index.Skin(mesh.vertices[i]);
    EXPECT_EQ(one.nodes, all[i].nodes);
    EXPECT_EQ(one.weights, all[i].weights);
  }
}

/// Equation 3 written down over the nodes within two edges of the nearest.
Skinning SkinByHand(const DeformationGraph& graph, int k,
                    const Eigen::Vector3f& point) {
  const auto squared = [&](int node) {
    return (graph.positions[node].cast<float>() - point).squaredNorm();
  };
  const auto nearer = [&](int a, int b) {
    return std::make_pair(squared(a), a) < std::make_pair(squared(b), b);
  };
  std::vector<int> all(graph.size());
  std::iota(all.begin(), all.end(), 0);
  const int nearest = *std::min_element(all.begin(), all.end(), nearer);
  std::set<int> found = {nearest};
  for (const int a : graph.neighbors[nearest]) {
    found.insert(a);
    found.insert(graph.neighbors[a].begin(), graph.neighbors[a].end());
  }
  std::vector<int> nodes(found.begin(), found.end());
  std::sort(nodes.begin(), nodes.end(), nearer);
  const float d_max = std::sqrt(squared(nodes[k]));
  std::sort(nodes.begin(), nodes.begin() + k);
  Skinning skinning;
  for (int i = 0; i < k; ++i) {
    const float closeness = 1 - std::sqrt(squared(nodes[i])) / d_max;
    skinning.nodes[i] = nodes[i];
    skinning.weights[i] = std::max(closeness * closeness, 1e-8f);
  }
  skinning.count = k;
  float sum = 0;
  for (int i = 0; i < k; ++i) sum += skinning.weights[i];
  for (int i = 0; i < k; ++i) skinning.weights[i] /= sum;
  return skinning;
}

TEST(Skinning, IsThatOfEquationThreeWhateverWasAskedBefore) {
  const TriangleMesh mesh = SheetMesh(0.5, 0.4, 0.01, [](double x, double y) {
    return Eigen::Vector3d(x, y, 1 + 0.1 * std::sin(9 * x) * std::cos(7 * y));
  });
  const DeformationGraph graph = CoverWithNodes(mesh, 0.04);
  const SkinningIndex index(graph, 6);
  SkinningSupport support;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
    const Eigen::Vector3f point =
        mesh.vertices[i] + Eigen::Vector3f(0.003f, -0.002f, 0.01f * (i % 4));
    const Skinning expected = SkinByHand(graph, 6, point);
    for (const Skinning& skinning :
         {index.Skin(point), index.Skin(point, &support)}) {
      EXPECT_EQ(skinning.count, expected.count);
      EXPECT_EQ(skinning.nodes, expected.nodes);
      EXPECT_EQ(skinning.weights, expected.weights);
    }
    EXPECT_EQ(support.nearest, index.NearestNode(point, nullptr));
  }
}

}  // namespace
}  // namespace splitfusion
