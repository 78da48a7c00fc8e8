#ifndef SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_

#include <ceres/jet.h>

#include <utility>
#include <vector>

#include "splitfusion/lib/energy/residual_scaling.h"
#include "splitfusion/lib/energy/unknown.h"

namespace splitfusion {

/// Where the values of points go, with room for dims() * count numbers a
/// column.
struct PointValues {
  double* residuals = nullptr;  ///< dims() a point.
  /// Derivatives by the warped point, 3 dims() a point; null: none are wanted.
  double* by_point = nullptr;
  /// Derivatives by the term's own unknowns, if it has any and `by_point` is
  /// not null: a column of dims() * count numbers each.
  double* by_unknowns = nullptr;
};

/// The residuals of one term as functions of warped points, and of the term's
/// own unknowns.
class PointResiduals {
 public:
  /// All share one scaling.
  explicit PointResiduals(ResidualScaling scaling)
      : scaling_(std::move(scaling)) {}
  virtual ~PointResiduals() = default;

  /// Residuals of one point.
  virtual int dims() const = 0;
  /// Number of unknowns of the term's own that they depend on.
  virtual int unknowns() const { return 0; }

  /// Evaluates `count` points from `first` on, in the order of WarpedPoints;
  /// `warped` are their warped positions (three a point, metres), `unknowns`
  /// the term's own in units of their scales. Residuals and derivatives are
  /// scaled, see ResidualScaling; the cost is added to `cost`. False if a
  /// functor refuses.
  virtual bool Evaluate(int first, int count, const double* warped,
                        const double* unknowns, const PointValues& values,
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
  static_assert(kDims > 0, "a functor has one residual or more");

  /// `functors[i]` belongs to point i of WarpedPoints.
  PointResidualsOf(std::vector<PointFunctor> functors, ResidualScaling scaling)
      : PointResiduals(std::move(scaling)), functors_(std::move(functors)) {}

  int dims() const override { return kDims; }

  bool Evaluate(int first, int count, const double* warped,
                const double* /*unknowns*/, const PointValues& values,
                double* cost) const override {
    for (int i = 0; i < count; ++i) {
      const PointFunctor& functor = functors_[first + i];
      const double* x = warped + 3 * i;
      double* r = values.residuals + kDims * i;
      double* derivative = values.by_point == nullptr
                               ? nullptr
                               : values.by_point + 3 * kDims * i;
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

/// The same of a functor with unknowns: kResiduals, kUnknowns, and
/// operator()(const T* warped_point, const T* unknowns, T* residual).
template <typename PointFunctor>
class PointResidualsWithUnknownsOf : public PointResiduals {
 public:
  /// Residuals of one point.
  static constexpr int kDims = PointFunctor::kResiduals;
  static_assert(kDims > 0, "a functor has one residual or more");
  /// Unknowns of the term.
  static constexpr int kUnknowns = PointFunctor::kUnknowns;

  /// `functors[i]` belongs to point i of WarpedPoints; `scales`: of the
  /// unknowns.
  PointResidualsWithUnknownsOf(std::vector<PointFunctor> functors,
                               std::vector<double> scales,
                               ResidualScaling scaling)
      : PointResiduals(std::move(scaling)),
        functors_(std::move(functors)),
        scales_(std::move(scales)) {}

  int dims() const override { return kDims; }
  int unknowns() const override { return kUnknowns; }

  bool Evaluate(int first, int count, const double* warped,
                const double* unknowns, const PointValues& values,
                double* cost) const override {
    const auto own = internal::ValuesOf<kUnknowns>(scales_, unknowns);
    const auto jets = internal::JetsOf<kWidth, kUnknowns>(scales_, unknowns,
                                                          /*first=*/3);
    JointJet point[3] = {{0, 0}, {0, 1}, {0, 2}}, value[kDims];
    double factor;
    for (int i = 0; i < count; ++i) {
      const PointFunctor& functor = functors_[first + i];
      const double* x = warped + 3 * i;
      double* r = values.residuals + kDims * i;
      if (values.by_point == nullptr) {
        if (!functor(x, own.data(), r)) return false;
        *cost += scaling().Apply(kDims, r, &factor);
        continue;
      }
      for (int e = 0; e < 3; ++e) point[e].a = x[e];
      if (!functor(point, jets.data(), value)) return false;
      for (int d = 0; d < kDims; ++d) r[d] = value[d].a;
      *cost += scaling().Apply(kDims, r, &factor);
      for (int d = 0; d < kDims; ++d) {
        Split(value[d], factor, kDims * i + d, kDims * count, values);
      }
    }
    return true;
  }

 private:
  /// Of Jets by the point, then by the unknowns. They are faster with an even
  /// number, of which the last may stay zero.
  static constexpr int kWidth = (3 + kUnknowns + 1) / 2 * 2;  // Layout.
  using JointJet = ceres::Jet<double, kWidth>;

  /// Brings the derivatives of one residual, times `factor`, where they belong;
  /// `rows`: of all points.
  static void Split(const JointJet& value, double factor, int row, int rows,
                    const PointValues& values) {
    for (int e = 0; e < 3; ++e) {
      values.by_point[3 * row + e] = factor * value.v[e];
    }
    for (int u = 0; u < kUnknowns; ++u) {
      values.by_unknowns[rows * u + row] = factor * value.v[3 + u];
    }
  }

  std::vector<PointFunctor> functors_;
  std::vector<double> scales_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_POINT_RESIDUALS_H_
