// Weights, losses and unknowns of terms that no parser has checked, each with
// every solver, of a rigid surface and of one that deforms.

#include <gtest/gtest.h>

#include <utility>

#include "splitfusion/lib/energy/solver.h"
#include "support/hostile_solve.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

std::vector<HostileCase> OptionCases() {
  const std::string weight = "hostile.weight = ", scale = "hostile.scale = ";
  std::vector<HostileCase> cases = {
      {"weight_nan", End::kRefused, weight + "nan", Points(Fault::kNone),
       Weight(kNan)},
      {"weight_negative", End::kRefused, weight + "-1", Points(Fault::kNone),
       Weight(-1)},
      {"weight_infinite", End::kRefused, weight + "inf", Points(Fault::kNone),
       Weight(kInfinity)},
      {"weight_1e308", End::kFails, "term 'hostile'", Points(Fault::kNone),
       Weight(1e308)},
      {"weight_1e200", End::kSolved, "", Points(Fault::kNone), Weight(1e200)},
      {"weight_of_almost_nothing", End::kSolved, "", Points(Fault::kNone),
       Weight(1e-320)},
      {"a_loss_that_is_none", End::kRefused, "hostile.loss = ",
       Points(Fault::kNone), Loss(static_cast<LossKind>(77), 0.01)},
      {"scale_unused", End::kSolved, "", Points(Fault::kNone),
       Loss(LossKind::kTrivial, kNan)},
      {"a_term_that_is_null", End::kRefused, "term 'hostile': expected a term",
       nullptr},
  };
  for (const LossKind loss :
       {LossKind::kHuber, LossKind::kTukey, LossKind::kCauchy}) {
    const std::string name = ToString(loss) + "_scale_";
    for (const auto& [text, value] :
         {std::pair("0", 0.0), std::pair("negative", -0.01),
          std::pair("nan", kNan), std::pair("infinite", kInfinity),
          std::pair("1e300", 1e300), std::pair("of_almost_nothing", 1e-310)}) {
      cases.push_back({name + text, End::kRefused, scale, Points(Fault::kNone),
                       Loss(loss, value)});
    }
  }
  return cases;
}

/// A residual 1 / (1 + u^2), which is the smaller the farther u is.
struct Endless {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;
  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = T(1) / (T(1) + unknowns[0] * unknowns[0]);
    return true;
  }
};

std::vector<HostileCase> UnknownCases() {
  const auto good = [](const Unknown& unknown) {
    return Gains(Fault::kNone, Fault::kNone, unknown);
  };
  const auto no_residuals = [](const auto&, auto*) {};
  const std::string of_term = "hostile.gain = ";
  std::vector<Unknown> many;
  for (int i = 0; i < 100000; ++i)
    many.push_back(Named("u" + std::to_string(i)));
  auto throwing = good(Named("gain"));
  throwing->unknowns = []() -> std::vector<Unknown> { throw 42; };
  return {
      {"unknown_without_a_name", End::kRefused, "unknown of a term = ''",
       good(Named(""))},
      {"unknown_with_a_space", End::kRefused, "unknown of a term = a gain",
       good(Named("a gain"))},
      {"unknown_of_one_name", End::kRefused, "unknown of a term = hostile.gain",
       WithUnknowns({Named("gain"), Named("gain")}, no_residuals)},
      {"unknown_at_nan", End::kRefused, "initial of unknown " + of_term,
       good(Named("gain", kNan))},
      {"unknown_at_infinity", End::kRefused, "initial of unknown " + of_term,
       good(Named("gain", kInfinity))},
      {"unknown_of_scale_0", End::kRefused, "scale of unknown " + of_term + "0",
       good(Named("gain", 0, 0))},
      {"unknown_of_scale_minus_1", End::kRefused,
       "scale of unknown " + of_term + "-1", good(Named("gain", 0, -1))},
      {"unknown_of_scale_nan", End::kRefused, "scale of unknown " + of_term,
       good(Named("gain", 0, kNan))},
      {"unknown_of_a_scale_too_small", End::kRefused,
       "scale of unknown " + of_term, good(Named("gain", 1, 1e-310))},
      {"unknown_of_scale_1e300", End::kFails, "term 'hostile' are not finite",
       good(Named("gain", 0, 1e300))},
      {"unknown_at_1e300", End::kFails, "cost of term 'hostile' is not finite",
       good(Named("gain", 1e300))},
      {"unknowns_by_the_thousand", End::kRefused,
       "unknowns of term 'hostile' = 100000: expected at most",
       WithUnknowns(many, no_residuals)},
      {"unknowns_that_throw", End::kThrows, "term 'hostile', Unknowns(): threw",
       throwing},
      {"unknowns_of_a_functor_alone", End::kRefused,
       "unknowns of a functor of term 'hostile' = 1: expected 0",
       WithUnknowns({}, Gains(Fault::kNone, Fault::kNone)->add)},
      {"unknowns_that_no_functor_has", End::kRefused,
       "unknowns of a functor of term 'hostile' = 1: expected 2",
       WithUnknowns({Named("gain"), Named("offset")},
                    Gains(Fault::kNone, Fault::kNone)->add)},
      {"unknowns_that_nothing_sees", End::kSolved, "",
       WithUnknowns({Named("gain", 3), Named("offset")}, no_residuals)},
      {"an_unknown_without_a_minimum", End::kSolved, "",
       WithUnknowns({Named("gain", 1, 1e-3)},
                    [](const auto&, ResidualSink* sink) {
                      sink->AddUnknowns(std::vector<Endless>(1));
                    })},
      {"a_prior_alone_of_the_energy", End::kSolved, "",
       WithUnknowns({Named("gain")},
                    [](const auto&, ResidualSink* sink) {
                      sink->AddUnknowns(std::vector<SpoiledPrior>(1));
                    })},
      {"a_start_at_nan",
       End::kRefused,
       "start of unknown " + of_term + "nan",
       good(Named("gain")),
       Weight(1),
       {kNan}},
      {"a_start_at_infinity",
       End::kRefused,
       "start of unknown " + of_term,
       good(Named("gain")),
       Weight(1),
       {-kInfinity}},
      {"too_many_starts",
       End::kRefused,
       "unknowns = 2: expected 1",
       good(Named("gain")),
       Weight(1),
       {0, 0}},
  };
}

class HostileOptions : public ::testing::TestWithParam<HostileCase> {};

TEST_P(HostileOptions, EndInOrder) { ExpectEnd(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Options, HostileOptions,
                         ::testing::ValuesIn(OptionCases()), NameOf);
INSTANTIATE_TEST_SUITE_P(Unknowns, HostileOptions,
                         ::testing::ValuesIn(UnknownCases()), NameOf);

TEST(HostileUnknowns, AreAskedForOnceASolve) {
  // Whatever a second answer were, it would be another one.
  const DeformationGraph start = PlateGraph();
  const std::vector<Correspondence> none;
  const PinholeCamera camera;
  for (const char* solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
    int calls = 0;
    auto term = Adding([](const auto&, ResidualSink* sink) {
      sink->AddUnknowns(std::vector<SpoiledPrior>(1));
    });
    term->unknowns = [&] {
      std::vector<Unknown> unknowns(++calls == 1 ? 1 : 7, Named("gain"));
      return unknowns;
    };
    const Energy energy = {{{"hostile"}, term}};
    SolverOptions options;
    options.solver = solver;
    DeformationGraph graph = start;
    const SolverReport report =
        Minimize({energy, none, camera}, options, &graph);
    EXPECT_TRUE(report.usable) << solver;
    ASSERT_EQ(report.unknowns.size(), 1u) << solver;
    EXPECT_NEAR(report.unknowns[0].final, 0.01, 1e-4) << solver;
    EXPECT_EQ(calls, 1) << solver;
  }
}

}  // namespace
}  // namespace splitfusion
