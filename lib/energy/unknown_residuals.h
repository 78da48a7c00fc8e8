#ifndef SPLITFUSION_LIB_ENERGY_UNKNOWN_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_UNKNOWN_RESIDUALS_H_

#include <algorithm>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/residual_scaling.h"
#include "splitfusion/lib/energy/unknown.h"

namespace splitfusion {

/// The residuals of one term as functions of its own unknowns alone: priors.
class UnknownResiduals {
 public:
  virtual ~UnknownResiduals() = default;

  /// Number of unknowns.
  virtual int unknowns() const = 0;
  /// Number of scalar residuals.
  virtual int rows() const = 0;

  /// Evaluates all residuals at the unknowns, which are in units of their
  /// scales, with their derivatives by these: a column of rows() numbers each.
  /// Values are scaled as those of PointResiduals, the cost is added to `cost`.
  /// False if a functor refuses.
  virtual bool Evaluate(const double* unknowns, double* residuals,
                        double* derivatives, double* cost) const = 0;
};

/// The residuals of template functors: kResiduals, kUnknowns, and
/// operator()(const T* unknowns, T* residual).
template <typename Functor>
class UnknownResidualsOf : public UnknownResiduals {
 public:
  /// Residuals of one functor.
  static constexpr int kDims = Functor::kResiduals;
  static_assert(kDims > 0, "a functor has one residual or more");
  /// Unknowns of the term.
  static constexpr int kUnknowns = Functor::kUnknowns;

  /// `scales`: of the unknowns.
  UnknownResidualsOf(std::vector<Functor> functors, std::vector<double> scales,
                     ResidualScaling scaling)
      : functors_(std::move(functors)),
        scales_(std::move(scales)),
        scaling_(std::move(scaling)) {}

  int unknowns() const override { return kUnknowns; }
  int rows() const override {
    return kDims * static_cast<int>(functors_.size());
  }

  bool Evaluate(const double* unknowns, double* residuals, double* derivatives,
                double* cost) const override {
    const auto jets =
        internal::JetsOf<kUnknowns, kUnknowns>(scales_, unknowns, /*first=*/0);
    double joint[kDims * kUnknowns];
    for (const Functor& functor : functors_) {
      if (!Differentiate(functor, jets.data(), residuals, joint)) return false;
      *cost += scaling_.Apply(kDims, kUnknowns, residuals, joint);
      for (int e = 0; e < kDims * kUnknowns; ++e) {
        derivatives[rows() * (e % kUnknowns) + e / kUnknowns] = joint[e];
      }
      residuals += kDims;
      derivatives += kDims;
    }
    return true;
  }

 private:
  using UnknownJet = ceres::Jet<double, kUnknowns>;

  static bool Differentiate(const Functor& functor, const UnknownJet* unknowns,
                            double* residual, double* joint) {
    UnknownJet value[kDims];
    if (!functor(unknowns, value)) return false;
    for (int d = 0; d < kDims; ++d) {
      residual[d] = value[d].a;
      joint = std::copy_n(value[d].v.data(), kUnknowns, joint);
    }
    return true;
  }

  std::vector<Functor> functors_;
  std::vector<double> scales_;
  ResidualScaling scaling_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_UNKNOWN_RESIDUALS_H_
