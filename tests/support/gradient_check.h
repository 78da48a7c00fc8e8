#ifndef SPLITFUSION_TESTS_SUPPORT_GRADIENT_CHECK_H_
#define SPLITFUSION_TESTS_SUPPORT_GRADIENT_CHECK_H_

#include <ceres/cost_function.h>
#include <ceres/dynamic_autodiff_cost_function.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace splitfusion {

/// Whether every entry a of a cost function's Jacobians agrees with its numeric
/// value n: |a - n| <= atol + rtol * (largest absolute entry of the block).
///
/// The numeric Jacobians are those of ceres::GradientChecker (Ridders'
/// method). Its own verdict is relative to each entry and rejects correct
/// functors where a derivative is zero.
::testing::AssertionResult GradientsMatch(
    const ceres::CostFunction& cost,
    const std::vector<std::vector<double>>& parameters, double atol = 1e-8,
    double rtol = 1e-7);

/// Dynamic autodiff of a functor (T const* const* twists, T* residual) over
/// `blocks` twists of six numbers.
template <typename Functor>
std::unique_ptr<ceres::CostFunction> AutoDiffOverTwists(Functor functor,
                                                        int blocks,
                                                        int residuals) {
  using Cost = ceres::DynamicAutoDiffCostFunction<Functor, 6>;
  auto cost = std::make_unique<Cost>(new Functor(std::move(functor)));
  for (int i = 0; i < blocks; ++i) cost->AddParameterBlock(6);
  cost->SetNumResiduals(residuals);
  return cost;
}

/// Residuals of a cost function.
std::vector<double> Residuals(
    const ceres::CostFunction& cost,
    const std::vector<std::vector<double>>& parameters);

}  // namespace splitfusion

/// Expects GradientsMatch; `cost` is a ceres::CostFunction.
#define EXPECT_GRADIENTS_MATCH(cost, parameters) \
  EXPECT_TRUE(::splitfusion::GradientsMatch(cost, parameters))

#endif  // SPLITFUSION_TESTS_SUPPORT_GRADIENT_CHECK_H_
