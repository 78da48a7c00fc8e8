// The checker itself: right functors pass, wrong ones are caught.

#include "support/gradient_check.h"

#include <ceres/sized_cost_function.h>
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "splitfusion/cost_functions/arap.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// r = sin(x) y, with a factor on the derivative by x; 1 is right.
class SineCost : public ceres::SizedCostFunction<1, 2> {
 public:
  explicit SineCost(double factor) : factor_(factor) {}
  bool Evaluate(double const* const* p, double* residual,
                double** jacobians) const override {
    residual[0] = std::sin(p[0][0]) * p[0][1];
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      jacobians[0][0] = factor_ * std::cos(p[0][0]) * p[0][1];
      jacobians[0][1] = std::sin(p[0][0]);
    }
    return true;
  }

 private:
  double factor_;
};

/// ARAP that forgets that the edge turns with omega_i: the value is right, the
/// derivative is not.
struct ArapWithoutRotationDerivative {
  Arap right;
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    T frozen[6];
    for (int d = 0; d < 3; ++d) frozen[d] = T(Value(twists[0][d]));
    for (int d = 3; d < 6; ++d) frozen[d] = twists[0][d];
    const T* const blocks[2] = {frozen, twists[1]};
    return right(blocks, residual);
  }
  static double Value(double x) { return x; }
  template <typename T>
  static double Value(const T& x) {
    return x.a;
  }
};

Arap SampleArap() {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.1, 0.1, 0.01, 1), 0.04);
  Shake(0.2, /*seed=*/1, &graph);
  return Arap::Make(graph, 0, 1);
}

TEST(GradientCheck, AcceptsARightDerivative) {
  const std::vector<std::vector<double>> at = {{0.7, -2.0}};
  EXPECT_GRADIENTS_MATCH(SineCost(1), at);
}

TEST(GradientCheck, CatchesAWrongSignAndOnePerMille) {
  EXPECT_FALSE(GradientsMatch(SineCost(-1), {{0.7, -2.0}}));
  EXPECT_FALSE(GradientsMatch(SineCost(1.001), {{0.7, -2.0}}));
  EXPECT_FALSE(GradientsMatch(
      SineCost(std::numeric_limits<double>::quiet_NaN()), {{0.7, -2.0}}));
}

TEST(GradientCheck, SaysWhichEntryIsWrong) {
  const auto result = GradientsMatch(SineCost(2), {{0.0, 1.0}});
  EXPECT_THAT(result.message(),
              ::testing::StartsWith("block 0, residual 0, parameter 0: "
                                    "derivative 2, numeric 1"));
}

TEST(GradientCheck, AcceptsArapWithItsZeroEntries) {
  // dr/dtau is +-identity: ceres::GradientChecker's own verdict fails here.
  const auto cost = AutoDiffOverTwists(SampleArap(), 2, 3);
  EXPECT_GRADIENTS_MATCH(*cost, RandomTwists(2, 0.3, /*seed=*/2));
}

TEST(GradientCheck, CatchesAnArapWithoutItsRotationDerivative) {
  const ArapWithoutRotationDerivative wrong{SampleArap()};
  const auto cost = AutoDiffOverTwists(wrong, 2, 3);
  const auto twists = RandomTwists(2, 0.3, /*seed=*/2);
  EXPECT_EQ(Residuals(*cost, twists),
            Residuals(*AutoDiffOverTwists(wrong.right, 2, 3), twists));
  EXPECT_FALSE(GradientsMatch(*cost, twists));
}

}  // namespace
}  // namespace splitfusion
