#include "support/gradient_check.h"

#include <ceres/gradient_checker.h>

#include <Eigen/Core>
#include <cmath>

namespace splitfusion {
namespace {

std::vector<const double*> Pointers(
    const std::vector<std::vector<double>>& parameters) {
  std::vector<const double*> pointers;
  for (const std::vector<double>& block : parameters) {
    pointers.push_back(block.data());
  }
  return pointers;
}

}  // namespace

::testing::AssertionResult GradientsMatch(
    const ceres::CostFunction& cost,
    const std::vector<std::vector<double>>& parameters, double atol,
    double rtol) {
  const std::vector<const ceres::Manifold*>* no_manifolds = nullptr;
  const ceres::GradientChecker checker(&cost, no_manifolds,
                                       ceres::NumericDiffOptions());
  ceres::GradientChecker::ProbeResults results;
  checker.Probe(Pointers(parameters).data(), /*relative_precision=*/1,
                &results);
  for (std::size_t block = 0; block < results.jacobians.size(); ++block) {
    const Eigen::MatrixXd& analytic = results.jacobians[block];
    const Eigen::MatrixXd& numeric = results.numeric_jacobians[block];
    const double largest =
        std::max(analytic.cwiseAbs().maxCoeff(), numeric.cwiseAbs().maxCoeff());
    for (int row = 0; row < analytic.rows(); ++row) {
      for (int column = 0; column < analytic.cols(); ++column) {
        const double a = analytic(row, column);
        const double n = numeric(row, column);
        // Not `>`: a NaN must fail.
        if (std::abs(a - n) <= atol + rtol * largest) continue;
        return ::testing::AssertionFailure()
               << "block " << block << ", residual " << row << ", parameter "
               << column << ": derivative " << a << ", numeric " << n;
      }
    }
  }
  return ::testing::AssertionSuccess();
}

std::vector<double> Residuals(
    const ceres::CostFunction& cost,
    const std::vector<std::vector<double>>& parameters) {
  std::vector<double> residuals(cost.num_residuals());
  if (!cost.Evaluate(Pointers(parameters).data(), residuals.data(), nullptr)) {
    residuals.clear();
  }
  return residuals;
}

}  // namespace splitfusion
