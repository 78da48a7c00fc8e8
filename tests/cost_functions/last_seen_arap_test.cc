#include "splitfusion/cost_functions/last_seen_arap.h"

#include <gtest/gtest.h>

#include "support/sample_graphs.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

/// Energy of the term; its residual vectors in `vectors`.
double Energy(const DeformationGraph& graph,
              const std::vector<Correspondence>& correspondences,
              double weight = 1, int* vectors = nullptr) {
  const TermOptions options{"last_seen_arap", weight, LossKind::kTrivial, 0.01};
  const AddedResiduals added = ResidualsOf(
      LastSeenArapTerm(), {graph, correspondences, PinholeCamera()}, options);
  if (vectors != nullptr) *vectors = added.residual_vectors;
  return EnergyOf(graph, added.residuals);
}

/// As many correspondences that hang on `node` alone.
void HangOn(int node, int count, std::vector<Correspondence>* all) {
  for (int i = 0; i < count; ++i) {
    Skinning& skinning = all->emplace_back().model.skinning;
    skinning.count = 1;
    skinning.nodes[0] = node;
    skinning.weights[0] = 1;
  }
}

/// A graph whose edges were last seen as those of `bent` are.
struct SeenBent {
  SeenBent() {
    Shake(0.05, /*seed=*/5, &bent);
    graph.seen_edges.resize(graph.size());
    for (int i = 0; i < graph.size(); ++i) {
      for (const int j : graph.neighbors[i]) {
        graph.seen_edges[i].push_back(
            bent.motions[i].rotation.transpose() *
            (bent.positions[i] + bent.motions[i].translation -
             bent.positions[j] - bent.motions[j].translation));
      }
    }
  }

  double EnergyAt(const std::vector<NodeMotion>& motions) const {
    DeformationGraph moved = graph;
    moved.motions = motions;
    return Energy(moved, {});
  }

  DeformationGraph graph = PlateGraph();
  DeformationGraph bent = graph;
};

TEST(LastSeenArapTerm, HiddenEdgesRestInTheShapeThatWasSeen) {
  const SeenBent scene;
  EXPECT_NEAR(scene.EnergyAt(scene.bent.motions), 0, 1e-12);
  EXPECT_GT(scene.EnergyAt(scene.graph.motions), 1);
}

TEST(LastSeenArapTerm, EdgesThatAreSeenAreFree) {
  const SeenBent scene;
  std::vector<Correspondence> all;
  for (int i = 0; i < scene.graph.size(); ++i) HangOn(i, 10, &all);
  int vectors = -1;
  EXPECT_EQ(Energy(scene.graph, all, 1, &vectors), 0);
  EXPECT_EQ(vectors, 0);
}

TEST(LastSeenArapTerm, WeighsAsMuchAnEdgeAsEquationSix) {
  SeenBent scene;
  for (int i = 0; i < scene.graph.size(); ++i) {
    for (std::size_t k = 0; k < scene.graph.neighbors[i].size(); ++k) {
      scene.graph.seen_edges[i][k] =
          scene.graph.positions[i] -
          scene.graph.positions[scene.graph.neighbors[i][k]];
    }
  }
  scene.graph.motions = scene.bent.motions;
  const TermOptions options{"arap", 3, LossKind::kTrivial, 0.01};
  const double arap = EnergyOf(
      scene.graph,
      ResidualsOf(ArapTerm(), {scene.graph, {}, PinholeCamera()}, options)
          .residuals);
  EXPECT_NEAR(Energy(scene.graph, {}, 3), arap, 1e-9 * arap);
}

/// Energy of one edge of 4 cm, last seen with 6 cm, if so many points hang on
/// its ends.
double EnergyOfLongEdge(int points_of_first, int points_of_second) {
  DeformationGraph graph;
  graph.positions = {{0, 0, 0}, {0.04, 0, 0}};
  graph.motions.resize(2);
  graph.neighbors = {{1}, {}};
  graph.seen_edges = {{{-0.06, 0, 0}}, {}};
  std::vector<Correspondence> correspondences;
  HangOn(0, points_of_first, &correspondences);
  HangOn(1, points_of_second, &correspondences);
  return Energy(graph, correspondences);
}

TEST(LastSeenArapTerm, AnEdgeIsAsHiddenAsItsHiddenEnd) {
  EXPECT_NEAR(EnergyOfLongEdge(4, 4), 0, 1e-12) << "both ends are seen";
  EXPECT_NEAR(EnergyOfLongEdge(8, 0), 4, 1e-9) << "2 cm too short";
  EXPECT_NEAR(EnergyOfLongEdge(0, 8), 4, 1e-9);
  EXPECT_NEAR(EnergyOfLongEdge(2, 4), 2, 1e-9) << "half of that";
}

TEST(LastSeenArapTerm, EdgesOfAnotherGraphAreNotHeld) {
  SeenBent scene;
  scene.graph.seen_edges[0].pop_back();
  EXPECT_EQ(Energy(scene.graph, {}), 0);
}

}  // namespace
}  // namespace splitfusion
