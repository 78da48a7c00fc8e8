#include "splitfusion/cost_functions/hidden_motion.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/sample_graphs.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kPlain{"term", 1, LossKind::kTrivial, 0.01};

/// Two nodes are sought, 10 cm apart; known is one of them in two frames.
class HiddenTerms : public testing::Test {
 protected:
  HiddenTerms() {
    graph_.positions = {{0, 0, 1}, {0.1, 0, 1}};
    graph_.motions.resize(2);
    graph_.neighbors.resize(2);
    links_.known_positions = {{0, 0, 1}, {0, 0, 1}};
    links_.known_motions.resize(2);
  }

  double EnergyOfTerm(const EnergyTerm& term) const {
    EnergyInput input{graph_, pairs_, camera_};
    input.links = &links_;
    return EnergyOf(graph_, ResidualsOf(term, input, kPlain).residuals);
  }

  DeformationGraph graph_;
  LinksInTime links_;
  const std::vector<Correspondence> pairs_;
  const PinholeCamera camera_;
};

TEST_F(HiddenTerms, ArapComparesEdgesWithThoseAtRest) {
  // From the sought node 1 to the sought node 0, and to a known one.
  links_.edges = {{1, 0}, {1, 2}};
  EXPECT_NEAR(EnergyOfTerm(HiddenArapTerm()), 0, 1e-12);
  // 3 cm off one of two edges, in units of 1 cm.
  graph_.motions[0].translation.y() = 0.03;
  EXPECT_NEAR(EnergyOfTerm(HiddenArapTerm()), 9.0 / 2, 1e-9);
  // A turn about the first end of an edge turns it with it.
  graph_.motions[0].translation.y() = 0;
  links_.edges = {{2, 1}};
  links_.known_motions[0].rotation = ExpSo3({0, 0, 0.3});
  graph_.motions[1].translation =
      ExpSo3({0, 0, 0.3}) * Eigen::Vector3d(0.1, 0, 0) -
      Eigen::Vector3d(0.1, 0, 0);
  EXPECT_NEAR(EnergyOfTerm(HiddenArapTerm()), 0, 1e-12);
}

TEST_F(HiddenTerms, SmoothnessIsTheSecondDifferenceInTime) {
  links_.triples = {{2, 0, 3}};
  links_.differences = {{1, -2, 1}};
  links_.known_motions[0].translation.x() = -0.02;
  links_.known_motions[1].translation.x() = 0.02;
  EXPECT_NEAR(EnergyOfTerm(HiddenSmoothnessTerm()), 0, 1e-12) << "it walks";
  graph_.motions[0].translation.y() = 0.01;
  EXPECT_NEAR(EnergyOfTerm(HiddenSmoothnessTerm()), 4, 1e-9);
}

TEST_F(HiddenTerms, AreAbsentWhereNothingIsLinked) {
  EnergyInput input{graph_, pairs_, camera_};
  EXPECT_EQ(ResidualsOf(HiddenArapTerm(), input, kPlain).residual_vectors, 0);
  EXPECT_EQ(ResidualsOf(HiddenSmoothnessTerm(), input, kPlain).residual_vectors,
            0);
}

}  // namespace
}  // namespace splitfusion
