#include "splitfusion/lib/energy/ceres_watch.h"

#include <cmath>
#include <utility>

#include "splitfusion/lib/energy/term_call.h"

namespace splitfusion {

/// A cost function that is watched.
class CeresWatch::Guarded : public ceres::CostFunction {
 public:
  Guarded(std::string term, std::unique_ptr<ceres::CostFunction> cost,
          CeresWatch* watch)
      : term_(std::move(term)), cost_(std::move(cost)), watch_(watch) {
    *mutable_parameter_block_sizes() = cost_->parameter_block_sizes();
    set_num_residuals(cost_->num_residuals());
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    try {
      const bool defined = CallTerm(term_, "evaluating", [&] {
        return cost_->Evaluate(parameters, residuals, jacobians);
      });
      if (!defined || !std::isfinite(Squared(residuals, num_residuals()))) {
        return false;
      }
    } catch (...) {
      watch_->Caught(std::current_exception());
      return false;
    }
    if (jacobians == nullptr || HasFinite(jacobians)) return true;
    watch_->Found(term_);
    return false;
  }

 private:
  static double Squared(const double* values, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += values[i] * values[i];
    return sum;
  }

  bool HasFinite(double** jacobians) const {
    for (std::size_t k = 0; k < parameter_block_sizes().size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      const int count = num_residuals() * parameter_block_sizes()[k];
      if (!std::isfinite(Squared(jacobians[k], count))) return false;
    }
    return true;
  }

  std::string term_;
  std::unique_ptr<ceres::CostFunction> cost_;
  CeresWatch* watch_;
};

std::unique_ptr<ceres::CostFunction> CeresWatch::Guard(
    const std::string& term, std::unique_ptr<ceres::CostFunction> cost) {
  return std::make_unique<Guarded>(term, std::move(cost), this);
}

void CeresWatch::Rethrow() const {
  if (error_ != nullptr) std::rethrow_exception(error_);
}

void CeresWatch::Caught(std::exception_ptr error) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (error_ == nullptr) error_ = std::move(error);
}

void CeresWatch::Found(const std::string& term) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!not_finite_.empty()) return;
  not_finite_ = "The derivatives of term '" + term + "' are not finite.";
}

}  // namespace splitfusion
