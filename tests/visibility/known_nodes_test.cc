#include "splitfusion/lib/visibility/known_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

constexpr double kSpacing = 0.04;
constexpr int kNow = 40;

/// A graph of which some nodes have been seen in frames 0 to 5 only, the others
/// in all frames up to kNow.
DeformationGraph PartlyHidden(
    DeformationGraph graph,
    const std::function<bool(const Eigen::Vector3d&)>& is_hidden) {
  graph.first_seen.assign(graph.size(), 0);
  for (const Eigen::Vector3d& g : graph.positions) {
    graph.sightings.push_back({{0, is_hidden(g) ? 5 : kNow}});
  }
  return graph;
}

DeformationGraph Plate(double width, double height) {
  return CoverWithNodes(PlateMesh(width, height, 0.013, 1), kSpacing);
}

int Count(const std::vector<char>& known) {
  return static_cast<int>(std::count(known.begin(), known.end(), true));
}

TEST(KnownNodes, AreAllThatWereSeenLately) {
  const DeformationGraph graph =
      PartlyHidden(Plate(0.6, 0.3), [](const auto&) { return false; });
  EXPECT_EQ(Count(KnownNodes(graph, kNow)), graph.size());
}

/// Which nodes of a plate are known although a disc about its middle is hidden.
std::vector<char> KnownAroundADisc(double radius, DeformationGraph* graph) {
  *graph = PartlyHidden(Plate(2.4, 2.4), [&](const Eigen::Vector3d& g) {
    return std::hypot(g.x() - 1.2, g.y() - 1.2) < radius;
  });
  return KnownNodes(*graph, kNow);
}

TEST(KnownNodes, AreTheHiddenOnesThatAreHeldFromAllAround) {
  DeformationGraph graph;
  const std::vector<char> small = KnownAroundADisc(0.3, &graph);
  EXPECT_EQ(Count(small), graph.size());
  const std::vector<char> large = KnownAroundADisc(1.1, &graph);
  EXPECT_LT(Count(large), graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    const double r =
        std::hypot(graph.positions[i].x() - 1.2, graph.positions[i].y() - 1.2);
    if (r < 0.2) {
      EXPECT_FALSE(large[i]) << r;
    }
    if (r > 1.05) {
      EXPECT_TRUE(large[i]) << r;
    }
  }
}

/// A long strip that is seen at one end is known up to some way along it.
TEST(KnownNodes, AreNotFarAlongAHiddenLimb) {
  const double end = 0.2;  // Of what is seen.
  const DeformationGraph graph = PartlyHidden(
      Plate(1.6, 0.12), [&](const Eigen::Vector3d& g) { return g.x() > end; });
  const std::vector<char> known = KnownNodes(graph, kNow);
  double last_known = 0, first_unknown = 2;
  for (int i = 0; i < graph.size(); ++i) {
    const double x = graph.positions[i].x();
    if (known[i]) {
      last_known = std::max(last_known, x);
    } else {
      first_unknown = std::min(first_unknown, x);
    }
  }
  EXPECT_LT(last_known, first_unknown + 2 * kSpacing);
  EXPECT_GT(first_unknown, end + 0.05);
  EXPECT_LT(last_known, end + 0.5);
}

TEST(KnownNodes, AreNotThoseThatNoEdgeHolds) {
  DeformationGraph graph =
      PartlyHidden(Plate(0.3, 0.3), [](const auto&) { return false; });
  graph.positions.emplace_back(0.1, 0.1, 1.1);
  graph.motions.emplace_back();
  graph.neighbors.emplace_back();
  graph.first_seen.push_back(0);
  graph.sightings.push_back({{0, 5}});
  EXPECT_FALSE(KnownNodes(graph, kNow).back());
  EXPECT_EQ(Count(KnownNodes(graph, kNow)), graph.size() - 1);
}

/// A hidden chain of m nodes behind a seen one. n_k = 1 + (n_k-1 + n_k+1) / 2,
/// n_0 = 0 and n_m = 1 + n_m-1 give n_k = k (2 m - k) steps.
TEST(KnownNodes, HaveTheWalkOfAChainByHand) {
  constexpr int kHidden = 9;
  DeformationGraph chain;
  for (int k = 0; k <= kHidden; ++k) {
    chain.positions.emplace_back(k * kSpacing, 0, 1);
    chain.neighbors.push_back(k == 0 ? std::vector<int>{}
                                     : std::vector<int>{k - 1});
    chain.sightings.push_back({{0, k == 0 ? kNow : 0}});
  }
  chain.first_seen.assign(chain.size(), 0);
  const std::vector<std::pair<double, int>> expected_by_spacing = {
      {0.04, 9}, {0.06, 2}, {0.08, 1}, {0.1, 0}};
  for (const auto& [spacing, expected] : expected_by_spacing) {
    chain.node_spacing = spacing;
    const std::vector<char> known = KnownNodes(chain, kNow);
    EXPECT_EQ(Count(known), 1 + expected) << spacing;
    for (int k = 1; k <= kHidden; ++k) {
      const double length = spacing * std::sqrt(k * (2.0 * kHidden - k));
      EXPECT_EQ(known[k] != 0, length <= kFirmWalk) << spacing << ' ' << k;
    }
  }
}

TEST(KnownNodes, AreNotInLoosePartsThatAreHidden) {
  DeformationGraph graph = PartlyHidden(
      Plate(0.3, 0.3), [](const Eigen::Vector3d&) { return false; });
  const int body = graph.size();
  const DeformationGraph part = Plate(0.15, 0.15);
  for (int i = 0; i < part.size(); ++i) {
    graph.positions.push_back(part.positions[i] + Eigen::Vector3d(1, 0, 0));
    graph.motions.emplace_back();
    graph.neighbors.push_back(part.neighbors[i]);
    for (int& j : graph.neighbors.back()) j += body;
    graph.first_seen.push_back(0);
    graph.sightings.push_back({{0, 5}});
  }
  const std::vector<char> known = KnownNodes(graph, kNow);
  EXPECT_EQ(Count(known), body);
  EXPECT_TRUE(std::all_of(known.begin(), known.begin() + body,
                          [](char value) { return value; }));
  // It is as long as it was in view lately, and once it is again.
  EXPECT_EQ(Count(KnownNodes(graph, 5 + kLatelyFrames - 1)), graph.size());
  EXPECT_EQ(Count(KnownNodes(graph, 5 + kLatelyFrames)), body);
  for (int i = body; i < graph.size(); ++i) {
    graph.sightings[i].push_back({kNow, kNow + 1});
  }
  EXPECT_EQ(Count(KnownNodes(graph, kNow - 1)), body);
  EXPECT_EQ(Count(KnownNodes(graph, kNow)), graph.size());
}

/// What was not seen at all in a frame is where it was in the last one that
/// showed anything of it.
TEST(KnownNodes, StayAsTheyWereWhileTheWholeSurfaceIsHidden) {
  const DeformationGraph graph = PartlyHidden(
      Plate(1.6, 0.12), [](const Eigen::Vector3d& g) { return g.x() > 0.2; });
  EXPECT_EQ(KnownNodes(graph, kNow + 100), KnownNodes(graph, kNow));
  EXPECT_LT(Count(KnownNodes(graph, kNow)), graph.size());
}

TEST(KnownNodes, AreNoneBeforeTheyWereSeen) {
  DeformationGraph graph =
      PartlyHidden(Plate(0.3, 0.3), [](const auto&) { return false; });
  for (int i = 0; i < graph.size(); ++i) {
    graph.first_seen[i] = 3;
    graph.sightings[i] = {{3, kNow}};
  }
  EXPECT_EQ(Count(KnownNodes(graph, 2)), 0);
  EXPECT_EQ(Count(KnownNodes(graph, 3)), graph.size());
}

TEST(KnownNodes, AreAllWhereItIsNotRecordedOfAll) {
  const DeformationGraph graph = PartlyHidden(
      Plate(1.6, 0.12), [](const Eigen::Vector3d& g) { return g.x() > 0.2; });
  EXPECT_LT(Count(KnownNodes(graph, kNow)), graph.size());
  for (const int recorded : {0, graph.size() - 1}) {
    DeformationGraph few_sightings = graph;
    few_sightings.sightings.resize(recorded);
    EXPECT_EQ(Count(KnownNodes(few_sightings, kNow)), graph.size());
    DeformationGraph few_first = graph;
    few_first.first_seen.resize(recorded);
    EXPECT_EQ(Count(KnownNodes(few_first, kNow)), graph.size());
  }
}

}  // namespace
}  // namespace splitfusion
