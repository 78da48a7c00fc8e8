#ifndef SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_

#include <ceres/jet.h>

#include <utility>
#include <vector>

#include "splitfusion/lib/energy/residual_scaling.h"

namespace splitfusion {

/// The residuals of one term as functions of warped points.
class PointResiduals {
 public:
  /// All share one scaling.
  explicit PointResiduals(ResidualScaling scaling)
      : scaling_(std::move(scaling)) {}
  virtual ~PointResiduals() = default;

  /// Residuals of one point.
  virtual int dims() const = 0;

  /// Evaluates `count` points from `first` on, in the order of WarpedPoints;
  /// `warped` are their warped positions (three a point, metres). Residuals and
  /// derivatives by the warped point (dims() and 3 dims() a point; `by_point`
  /// may be null) are scaled, see ResidualScaling; the cost is added to `cost`.
  /// False if a functor refuses.
  virtual bool Evaluate(int first, int count, const double* warped,
                        double* residuals, double* by_point,
                        double* cost) const = 0;

  /// Units, loss and weight.
  const ResidualScaling& scaling() const { return scaling_; }

 private:
  ResidualScaling scaling_;
};

/// The residuals of a template functor: kResiduals, and operator()(const T*
/// warped_point, T* residual). Derivatives by Jets over the three coordinates;
/// the chain rule does the rest (WarpedPoints), which costs about a fifth of
/// one wide Jet a point.
template <typename PointFunctor>
class PointResidualsOf : public PointResiduals {
 public:
  /// Residuals of one point.
  static constexpr int kDims = PointFunctor::kResiduals;

  /// `functors[i]` belongs to point i of WarpedPoints.
  PointResidualsOf(std::vector<PointFunctor> functors, ResidualScaling scaling)
      : PointResiduals(std::move(scaling)), functors_(std::move(functors)) {}

  int dims() const override { return kDims; }

  bool Evaluate(int first, int count, const double* warped, double* residuals,
                double* by_point, double* cost) const override {
    for (int i = 0; i < count; ++i) {
      const PointFunctor& functor = functors_[first + i];
      const double* x = warped + 3 * i;
      double* r = residuals + kDims * i;
      double* derivative =
          by_point == nullptr ? nullptr : by_point + 3 * kDims * i;
      const bool defined = derivative == nullptr
                               ? functor(x, r)
                               : Differentiate(functor, x, r, derivative);
      if (!defined) return false;
      *cost += scaling().Apply(kDims, 3, r, derivative);
    }
    return true;
  }

 private:
  static bool Differentiate(const PointFunctor& functor, const double* x,
                            double* residual, double* derivative) {
    using Jet3 = ceres::Jet<double, 3>;
    const Jet3 point[3] = {{x[0], 0}, {x[1], 1}, {x[2], 2}};
    Jet3 value[kDims];
    if (!functor(point, value)) return false;
    for (int d = 0; d < kDims; ++d) {
      residual[d] = value[d].a;
      for (int e = 0; e < 3; ++e) derivative[3 * d + e] = value[d].v[e];
    }
    return true;
  }

  std::vector<PointFunctor> functors_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_
