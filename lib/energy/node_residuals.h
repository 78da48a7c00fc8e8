#ifndef SPLITFUSION_LIB_ENERGY_NODE_RESIDUALS_H_
#define SPLITFUSION_LIB_ENERGY_NODE_RESIDUALS_H_

#include <ceres/jet.h>

#include <utility>
#include <vector>

#include "splitfusion/lib/energy/residual_scaling.h"
#include "splitfusion/lib/energy/twist.h"

namespace splitfusion {

/// The residuals of one term as functions of the twists of node tuples.
class NodeResiduals {
 public:
  /// `nodes[i]`: tuple i.
  NodeResiduals(std::vector<std::vector<int>> nodes, ResidualScaling scaling)
      : nodes_(std::move(nodes)), scaling_(std::move(scaling)) {}
  virtual ~NodeResiduals() = default;

  /// Number of tuples.
  int size() const { return static_cast<int>(nodes_.size()); }
  /// Nodes of a tuple, in its functor's order.
  const std::vector<int>& nodes(int tuple) const { return nodes_[tuple]; }
  /// Residuals of one tuple.
  virtual int dims() const = 0;

  /// Evaluates one tuple at `twists[k]` of its k-th node. `jacobian` (dims() x
  /// 6 nodes, by rows) may be null. Values are scaled as those of
  /// PointResiduals, `cost` receives the cost. False if the functor refuses.
  virtual bool Evaluate(int tuple, double const* const* twists,
                        double* residuals, double* jacobian,
                        double* cost) const = 0;

  /// Units, loss and weight.
  const ResidualScaling& scaling() const { return scaling_; }

 private:
  std::vector<std::vector<int>> nodes_;
  ResidualScaling scaling_;
};

/// The residuals of a template functor: kResiduals, and operator()(T const*
/// const* twists, T* residual). Plain autodiff.
template <typename Functor>
class NodeResidualsOf : public NodeResiduals {
 public:
  /// Residuals of one tuple.
  static constexpr int kDims = Functor::kResiduals;
  static_assert(kDims > 0, "a functor has one residual or more");

  /// `functors[i]` sees the twists of `nodes[i]`.
  NodeResidualsOf(std::vector<std::vector<int>> nodes,
                  std::vector<Functor> functors, ResidualScaling scaling)
      : NodeResiduals(std::move(nodes), std::move(scaling)),
        functors_(std::move(functors)) {}

  int dims() const override { return kDims; }

  bool Evaluate(int tuple, double const* const* twists, double* residuals,
                double* jacobian, double* cost) const override {
    const Functor& functor = functors_[tuple];
    const int count = static_cast<int>(nodes(tuple).size());
    if (jacobian == nullptr) {
      if (!functor(twists, residuals)) return false;
    } else if (!(count <= kFewNodes ? DifferentiateFew(functor, count, twists,
                                                       residuals, jacobian)
                                    : DifferentiateMany(functor, count, twists,
                                                        residuals, jacobian))) {
      return false;
    }
    *cost = scaling().Apply(kDims, kTwistSize * count, residuals, jacobian);
    return true;
  }

 private:
  using Jet6 = ceres::Jet<double, kTwistSize>;
  /// Nodes for which there is room on the stack.
  static constexpr int kFewNodes = 2;  // Speed.

  static bool DifferentiateFew(const Functor& functor, int count,
                               double const* const* twists, double* residuals,
                               double* jacobian) {
    Jet6 jets[kFewNodes * kTwistSize];
    const Jet6* blocks[kFewNodes];
    return Differentiate(functor, count, twists, jets, blocks, residuals,
                         jacobian);
  }

  static bool DifferentiateMany(const Functor& functor, int count,
                                double const* const* twists, double* residuals,
                                double* jacobian) {
    std::vector<Jet6> jets(count * kTwistSize);
    std::vector<const Jet6*> blocks(count);
    return Differentiate(functor, count, twists, jets.data(), blocks.data(),
                         residuals, jacobian);
  }

  /// One pass a node: Jets of six are faster than wider ones. `jets` and
  /// `blocks` are room for the twists.
  static bool Differentiate(const Functor& functor, int count,
                            double const* const* twists, Jet6* jets,
                            const Jet6** blocks, double* residuals,
                            double* jacobian) {
    for (int k = 0; k < count; ++k) {
      blocks[k] = jets + kTwistSize * k;
      for (int d = 0; d < kTwistSize; ++d) {
        jets[kTwistSize * k + d] = Jet6(twists[k][d]);
      }
    }
    for (int k = 0; k < count; ++k) {
      Jet6* own = jets + kTwistSize * k;
      for (int d = 0; d < kTwistSize; ++d) own[d].v[d] = 1;
      Jet6 value[kDims];
      if (!functor(blocks, value)) return false;
      for (int d = 0; d < kTwistSize; ++d) own[d].v[d] = 0;
      for (int row = 0; row < kDims; ++row) {
        residuals[row] = value[row].a;
        double* out = jacobian + kTwistSize * (row * count + k);
        for (int d = 0; d < kTwistSize; ++d) out[d] = value[row].v[d];
      }
    }
    return true;
  }

  std::vector<Functor> functors_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_NODE_RESIDUALS_H_
