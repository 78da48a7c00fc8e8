#ifndef SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
#define SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_

#include <ceres/dynamic_autodiff_cost_function.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/energy/robust_loss.h"
#include "splitfusion/lib/energy/warped_point_group.h"

namespace splitfusion {

/// Scale s of the energy: residuals are compared with 1 cm, so that a weight
/// means the same in every frame and on every surface.
constexpr double kResidualUnit = 0.01;  // Metres.

/// Weight and loss of one term, as the command line gives them.
struct TermOptions {
  /// Registered name of the term.
  std::string name;
  double weight = 1;  ///< Of E_term; dimensionless.
  /// Robust loss of every residual vector.
  LossKind loss = LossKind::kTrivial;
  double scale = 0.01;  ///< Inlier width of the loss, metres.
};

/// One block of residuals over some nodes' twists.
struct ResidualBlock {
  /// Residuals and Jacobians over the nodes' twists.
  std::unique_ptr<ceres::CostFunction> cost;
  /// Nodes of the parameter blocks, in order.
  std::vector<int> nodes;
  /// Loss that Ceres applies to the block; null if the block has applied it.
  std::shared_ptr<ceres::LossFunction> loss;
};

/// Receives the residuals of one term. It owns the parameter layout: terms name
/// graph nodes.
class ResidualSink {
 public:
  /// Residuals are scaled so that the blocks' cost sums to
  /// weight_factor * options.weight / N * sum of rho(|r|^2 / s^2).
  ResidualSink(const DeformationGraph& graph, const TermOptions& options,
               double weight_factor)
      : graph_(graph), options_(options), weight_factor_(weight_factor) {}

  /// Adds one residual vector per model sample; `functors[i]` sees the warped
  /// point of `samples[i]`. PointFunctor: kResiduals, and a template
  /// operator()(const T* warped_point, T* residual) in metres. Call it once.
  template <typename PointFunctor>
  void AddWarpedPoints(const std::vector<const ModelSample*>& samples,
                       const std::vector<PointFunctor>& functors);

  /// Adds one residual vector per node tuple; `functors[i]` sees the twists of
  /// `nodes[i]` as (T const* const* twists, T* residual), in metres. Plain
  /// dynamic autodiff. Call it once.
  template <typename Functor>
  void AddNodes(const std::vector<std::vector<int>>& nodes,
                const std::vector<Functor>& functors);

  /// N of the normalisation.
  int residual_vectors() const { return residual_vectors_; }
  /// The blocks so far; the caller may move them out.
  std::vector<ResidualBlock>& blocks() { return blocks_; }

 private:
  /// Root of the factor that turns Ceres' 1/2 sum into the term's energy.
  double WeightRoot() const {
    return std::sqrt(2 * weight_factor_ * options_.weight /
                     std::max(1, residual_vectors_));
  }

  const DeformationGraph& graph_;
  const TermOptions& options_;
  double weight_factor_;
  int residual_vectors_ = 0;
  std::vector<ResidualBlock> blocks_;
};

namespace internal {

/// Points a block holds at most: bounds the memory of one evaluation.
constexpr int kMaxGroupSize = 512;

/// Order of points in which those with the same node set are adjacent; node
/// lists are ascending, so equal sets are equal lists.
inline std::vector<int> OrderByNodes(
    const std::vector<const ModelSample*>& samples) {
  std::vector<int> order(samples.size());
  std::iota(order.begin(), order.end(), 0);
  const auto nodes_of = [&](int i) {
    return samples[i]->skinning.nodes.data();
  };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::lexicographical_compare(
        nodes_of(a), nodes_of(a) + samples[a]->skinning.count, nodes_of(b),
        nodes_of(b) + samples[b]->skinning.count);
  });
  return order;
}

/// A functor scaled by a constant, so that residuals are in units of s.
template <typename Functor>
struct ScaledFunctor {
  Functor functor;
  double scale;
  template <typename T>
  bool operator()(T const* const* twists, T* residuals) const {
    if (!functor(twists, residuals)) return false;
    for (int d = 0; d < Functor::kResiduals; ++d) residuals[d] *= T(scale);
    return true;
  }
};

}  // namespace internal

template <typename PointFunctor>
void ResidualSink::AddWarpedPoints(
    const std::vector<const ModelSample*>& samples,
    const std::vector<PointFunctor>& functors) {
  using Group = WarpedPointGroup<PointFunctor>;
  residual_vectors_ = static_cast<int>(samples.size());
  const std::shared_ptr<ceres::LossFunction> loss =
      MakeLoss(options_.loss, options_.scale / kResidualUnit);
  std::unique_ptr<Group> group;
  const auto flush = [&] {
    if (group == nullptr) return;
    std::vector<int> nodes = group->nodes();
    blocks_.push_back({std::move(group), std::move(nodes), nullptr});
  };
  for (const int i : internal::OrderByNodes(samples)) {
    const Skinning& skinning = samples[i]->skinning;
    const bool same =
        group != nullptr && group->size() < internal::kMaxGroupSize &&
        static_cast<int>(group->nodes().size()) == skinning.count &&
        std::equal(group->nodes().begin(), group->nodes().end(),
                   skinning.nodes.begin());
    if (!same) {
      flush();
      group = std::make_unique<Group>(
          graph_,
          std::vector<int>(skinning.nodes.begin(),
                           skinning.nodes.begin() + skinning.count),
          1 / kResidualUnit, WeightRoot(), loss);
    }
    group->Add(graph_, skinning, samples[i]->point, functors[i]);
  }
  flush();
}

template <typename Functor>
void ResidualSink::AddNodes(const std::vector<std::vector<int>>& nodes,
                            const std::vector<Functor>& functors) {
  residual_vectors_ = static_cast<int>(nodes.size());
  const double weight = WeightRoot() * WeightRoot();
  const std::shared_ptr<ceres::LossFunction> loss =
      std::make_shared<ceres::ScaledLoss>(
          MakeLoss(options_.loss, options_.scale / kResidualUnit).release(),
          weight, ceres::TAKE_OWNERSHIP);
  using Scaled = internal::ScaledFunctor<Functor>;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    auto cost = std::make_unique<ceres::DynamicAutoDiffCostFunction<Scaled, 6>>(
        new Scaled{functors[i], 1 / kResidualUnit});
    for (std::size_t k = 0; k < nodes[i].size(); ++k) {
      cost->AddParameterBlock(kTwistSize);
    }
    cost->SetNumResiduals(Functor::kResiduals);
    blocks_.push_back({std::move(cost), nodes[i], loss});
  }
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
