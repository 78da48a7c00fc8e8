// Terms that are wrong in their residuals, each with every solver, of a rigid
// surface and of one that deforms: they are refused by a line that names them,
// or the solve ends in order and says what was wrong.

#include <gtest/gtest.h>

#include <climits>

#include "splitfusion/lib/energy/solver.h"
#include "support/hostile_solve.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

std::shared_ptr<HostileTerm> Tuple(const std::vector<int>& nodes) {
  return Adding([nodes](const EnergyInput&, ResidualSink* sink) {
    sink->AddNodes({nodes}, std::vector<SpoiledNode>(1));
  });
}

/// A term over copies of the first samples, the last of which is changed.
std::shared_ptr<HostileTerm> Sample(
    const std::function<void(ModelSample*)>& change) {
  return Adding([change](const EnergyInput& input, ResidualSink* sink) {
    std::vector<ModelSample> samples;
    std::vector<const ModelSample*> pointers;
    for (int i = 0; i < 5; ++i) {
      samples.push_back(input.correspondences[i].model);
    }
    change(&samples.back());
    for (const ModelSample& sample : samples) pointers.push_back(&sample);
    sink->AddWarpedPoints(pointers, std::vector<SpoiledPoint>(5));
  });
}

std::shared_ptr<HostileTerm> Total(double total) {
  return Adding([total](const EnergyInput& input, ResidualSink* sink) {
    const auto samples = ModelSamplesOf(input);
    sink->AddWarpedPoints(samples, std::vector<SpoiledPoint>(samples.size()),
                          total);
  });
}

std::vector<HostileCase> FunctorCases() {
  const std::string cost = "cost of term 'hostile' is not finite";
  const std::string slope = "derivatives of term 'hostile' are not finite";
  const std::string term = "term 'hostile'";
  return {
      {"nan", End::kFails, cost, Points(Fault::kNan)},
      {"nan_in_one_point", End::kFails, cost, OnePoint(Fault::kNan)},
      {"nan_under_a_loss", End::kFails, cost, Points(Fault::kNan),
       Loss(LossKind::kTukey, 0.01)},
      {"nan_of_weight_0", End::kFails, cost, Points(Fault::kNan), Weight(0)},
      {"infinite", End::kFails, cost, Points(Fault::kInfinite)},
      {"infinite_in_one_point", End::kFails, cost, OnePoint(Fault::kInfinite)},
      {"infinite_under_a_loss", End::kFails, cost, OnePoint(Fault::kInfinite),
       Loss(LossKind::kTukey, 0.01)},
      {"nan_of_nodes", End::kFails, cost, Nodes(Fault::kNan)},
      {"nan_of_a_prior", End::kFails, cost, Gains(Fault::kNone, Fault::kNan)},
      {"nan_slope", End::kFails, slope, Points(Fault::kNanSlope)},
      {"nan_slope_in_one_point", End::kFails, slope,
       OnePoint(Fault::kNanSlope)},
      {"nan_slope_of_nodes", End::kFails, slope, Nodes(Fault::kNanSlope)},
      {"nan_slope_with_unknowns", End::kFails, slope,
       Gains(Fault::kNanSlope, Fault::kNone)},
      {"nan_slope_of_a_prior", End::kFails, slope,
       Gains(Fault::kNone, Fault::kNanSlope)},
      {"nan_slope_after_a_step", End::kFails, slope,
       Points(Fault::kLateNanSlope)},
      {"infinite_slope", End::kFails, slope, Points(Fault::kInfiniteSlope)},
      {"infinite_slope_in_one_point", End::kFails, slope,
       OnePoint(Fault::kInfiniteSlope)},
      {"nan_without_slope", End::kStays, cost, Points(Fault::kNanWithoutSlope)},
      {"huge", End::kFails, cost, Points(Fault::kHuge)},
      {"huge_slope", End::kFails, slope, Points(Fault::kHugeSlope)},
      {"steep", End::kSolved, "", Points(Fault::kSteep)},
      {"steep_in_one_point", End::kFinite, "", OnePoint(Fault::kSteep)},
      {"steep_nodes", End::kSolved, "", Nodes(Fault::kSteep)},
      {"faint", End::kSolved, "", Points(Fault::kFaint)},
      {"constant", End::kSolved, "", Points(Fault::kConstant)},
      {"constant_nodes", End::kSolved, "", Nodes(Fault::kConstant)},
      {"wrong_sign", End::kSolved, "", Points(Fault::kWrongSign)},
      {"noise", End::kFinite, "", Points(Fault::kNoise)},
      {"refuses", End::kFails, cost, Points(Fault::kRefuses)},
      {"refuses_one_point", End::kFails, cost, OnePoint(Fault::kRefuses)},
      {"refuses_nodes", End::kFails, cost, Nodes(Fault::kRefuses)},
      {"throws_at_a_point", End::kThrows,
       "term 'hostile', evaluating: no such map", OnePoint(Fault::kThrows)},
      {"throws_at_a_node", End::kThrows, term, Nodes(Fault::kThrows)},
      {"throws_in_a_prior", End::kThrows, term,
       Gains(Fault::kNone, Fault::kThrows)},
      {"throws_input_error_at_a_point", End::kRefused,
       "term 'hostile', evaluating: map.png: no such map",
       Points(Fault::kThrowsInputError)},
      {"throws_a_number_at_a_point", End::kThrows,
       "term 'hostile', evaluating: threw what is no std::exception",
       Points(Fault::kThrowsNumber)},
      {"throws_a_number_at_a_node", End::kThrows, term,
       Nodes(Fault::kThrowsNumber)},
  };
}

std::vector<HostileCase> AddingCases() {
  const std::string term = "term 'hostile', AddResiduals(): ";
  return {
      {"throws", End::kThrows, term + "gone",
       Adding([](const auto&, auto*) { throw std::runtime_error("gone"); })},
      {"throws_input_error", End::kRefused, term + "a.csv: gone",
       Adding([](const auto&, auto*) { throw InputError("a.csv: gone"); })},
      {"throws_a_number", End::kThrows,
       term + "threw what is no std::exception",
       Adding([](const auto&, auto*) { throw 42; })},
      {"throws_null", End::kThrows, term,
       Adding([](const auto&, auto*) { throw nullptr; })},
      {"asks_for_too_much_memory", End::kThrows, term,
       Adding([](const auto&, auto*) {
         std::vector<int>().reserve(std::vector<int>().max_size());
       })},
      {"wants_a_live_frame", End::kRefused, term + "expected a live frame",
       Adding([](const EnergyInput& input, auto*) {
         if (input.live == nullptr) throw InputError("expected a live frame");
       })},
      {"reads_past_the_end", End::kThrows, term,
       Adding([](const EnergyInput& input, auto*) {
         input.correspondences.at(input.correspondences.size());
       })},
      {"adds_nothing", End::kSolved, "", Adding([](const auto&, auto*) {})},
      {"adds_empty_lists", End::kSolved, "",
       WithUnknowns({Named("gain")},
                    [](const auto&, ResidualSink* sink) {
                      sink->AddWarpedPoints({}, std::vector<SpoiledGain>());
                      sink->AddNodes({}, std::vector<SpoiledNode>());
                      sink->AddUnknowns(std::vector<SpoiledPrior>());
                    })},
      {"adds_points_twice", End::kRefused, term + "AddWarpedPoints() twice",
       Adding([](const EnergyInput& input, ResidualSink* sink) {
         for (int i = 0; i < 2; ++i) Points(Fault::kNone)->add(input, sink);
       })},
      {"adds_nodes_twice", End::kRefused, term + "AddNodes() twice",
       Adding([](const EnergyInput& input, ResidualSink* sink) {
         for (int i = 0; i < 2; ++i) Nodes(Fault::kNone)->add(input, sink);
       })},
      {"adds_priors_twice", End::kRefused, term + "AddUnknowns() twice",
       WithUnknowns({Named("gain")},
                    [](const auto&, ResidualSink* sink) {
                      for (int i = 0; i < 2; ++i) {
                        sink->AddUnknowns(std::vector<SpoiledPrior>(1));
                      }
                    })},
      {"a_node_past_the_end", End::kRefused, term + "nodes of a residual = ",
       Adding([](const EnergyInput& input, ResidualSink* sink) {
         Tuple({input.graph.size()})->add(input, sink);
       })},
      {"node_minus_1", End::kRefused, term + "nodes of a residual = -1",
       Tuple({-1})},
      {"node_int_max", End::kRefused, term + "nodes of a residual = 2147483647",
       Tuple({INT_MAX})},
      {"node_int_min", End::kRefused,
       term + "nodes of a residual = 0 -2147483648", Tuple({0, INT_MIN})},
      {"a_node_twice", End::kRefused,
       term + "nodes of a residual = 0 0: expected different nodes",
       Tuple({0, 0})},
      {"no_nodes", End::kRefused, term + "nodes of a residual = none",
       Tuple({})},
      {"a_sample_of_no_node", End::kRefused, term + "nodes of a sample = 0",
       Sample([](ModelSample* s) { s->skinning.count = 0; })},
      {"a_sample_of_minus_1_nodes", End::kRefused,
       term + "nodes of a sample = -1",
       Sample([](ModelSample* s) { s->skinning.count = -1; })},
      {"a_sample_of_int_max_nodes", End::kRefused,
       term + "nodes of a sample = 2147483647",
       Sample([](ModelSample* s) { s->skinning.count = INT_MAX; })},
      {"a_sample_of_node_int_max", End::kRefused,
       term + "nodes of a residual = 2147483647", Sample([](ModelSample* s) {
         s->skinning.count = 1;
         s->skinning.nodes[0] = INT_MAX;
       })},
      {"a_sample_that_is_null", End::kRefused, term + "sample of a residual",
       Adding([](const auto&, ResidualSink* sink) {
         sink->AddWarpedPoints({nullptr}, std::vector<SpoiledPoint>(1));
       })},
      {"a_sample_at_nan", End::kFails, "cost of term 'hostile' is not finite",
       Sample([](ModelSample* s) { s->point.setConstant(std::nanf("")); })},
      {"a_sample_far_away", End::kFails, "cost of term 'hostile' is not finite",
       Sample([](ModelSample* s) {
         s->point.setConstant(3e38f);
         s->skinning.weights.fill(3e38f);
         s->skinning.weights[0] = -1e38f;
       }),
       Weight(1e250)},
      {"a_functor_too_few", End::kRefused, term + "functors of residuals = 0",
       Adding([](const EnergyInput& input, ResidualSink* sink) {
         sink->AddWarpedPoints({&input.correspondences[0].model},
                               std::vector<SpoiledPoint>());
       })},
      {"a_functor_too_many", End::kRefused, term + "functors of residuals = 2",
       Adding([](const auto&, ResidualSink* sink) {
         sink->AddNodes({{0}}, std::vector<SpoiledNode>(2));
       })},
      {"total_nan", End::kRefused, term + "total of residuals = nan",
       Total(kNan)},
      {"total_negative", End::kRefused, term + "total of residuals = -1",
       Total(-1)},
      {"total_infinite", End::kRefused, term + "total of residuals = inf",
       Total(kInfinity)},
      {"total_of_almost_nothing", End::kFails,
       "cost of term 'hostile' is not finite", Total(1e-310)},
  };
}

class HostileTerms : public ::testing::TestWithParam<HostileCase> {};

TEST_P(HostileTerms, EndInOrder) { ExpectEnd(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Functors, HostileTerms,
                         ::testing::ValuesIn(FunctorCases()), NameOf);
INSTANTIATE_TEST_SUITE_P(Adding, HostileTerms,
                         ::testing::ValuesIn(AddingCases()), NameOf);

TEST(HostileTermsOverRounds, MayAddAnotherNumberOfResidualsEachTime) {
  const std::vector<Correspondence> none;
  const PinholeCamera camera;
  for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
    DeformationGraph graph = PlateGraph();
    int count = 0;
    const Energy energy = {
        {{"hostile"}, Adding([&](const auto&, ResidualSink* sink) {
           std::vector<std::vector<int>> nodes;
           for (int i = 0; i < count; ++i) nodes.push_back({i});
           sink->AddNodes(nodes, std::vector<SpoiledNode>(nodes.size()));
         })}};
    SolverOptions options;
    options.solver = solver;
    for (const int residuals : {0, 3, 14, 0, 1}) {
      count = residuals;
      const SolverReport report =
          Minimize({energy, none, camera}, options, &graph);
      EXPECT_TRUE(report.usable) << report.message;
      EXPECT_EQ(report.residuals, residuals) << solver;
      EXPECT_EQ(report.terms[0].residual_vectors, residuals) << solver;
      EXPECT_LE(report.final_cost, report.initial_cost) << solver;
    }
  }
}

}  // namespace
}  // namespace splitfusion
