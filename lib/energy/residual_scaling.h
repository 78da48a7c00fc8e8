#ifndef SPLITFUSION_LIB_ENERGY_RESIDUAL_SCALING_H_
#define SPLITFUSION_LIB_ENERGY_RESIDUAL_SCALING_H_

#include <ceres/loss_function.h>

#include <cmath>
#include <memory>

namespace splitfusion {

/// Units, robust loss and weight of a term's residual vectors.
struct ResidualScaling {
  double residual_scale = 1;  ///< Multiplies residuals before the loss.
  double weight_root = 1;     ///< Multiplies them after it.
  /// Of the squared norm of every residual vector; null: none.
  std::shared_ptr<const ceres::LossFunction> loss;

  /// Scales one residual vector and its Jacobian (rows x columns, by rows; may
  /// be null) as Ceres' corrector does for losses with rho'' <= 0: by
  /// sqrt(rho'(s)), s = |r|^2. Returns the cost, 1/2 weight_root^2 rho(s); not
  /// a number if s is none, where some losses are constant.
  double Apply(int rows, int columns, double* residuals,
               double* jacobian) const {
    double factor;
    const double cost = Apply(rows, residuals, &factor);
    const int entries = jacobian == nullptr ? 0 : rows * columns;
    for (int e = 0; e < entries; ++e) jacobian[e] *= factor;
    return cost;
  }

  /// The same of the residuals alone; `factor`: what their Jacobian is to be
  /// multiplied with.
  double Apply(int rows, double* residuals, double* factor) const {
    double squared = 0;
    for (int d = 0; d < rows; ++d) {
      residuals[d] *= residual_scale;
      squared += residuals[d] * residuals[d];
    }
    double rho[3] = {squared, 1, 0};
    if (loss != nullptr) loss->Evaluate(squared, rho);
    const double root = weight_root * std::sqrt(rho[1]);
    for (int d = 0; d < rows; ++d) residuals[d] *= root;
    *factor = root * residual_scale;
    if (!std::isfinite(squared)) return std::nan("");
    return 0.5 * weight_root * weight_root * rho[0];
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_RESIDUAL_SCALING_H_
