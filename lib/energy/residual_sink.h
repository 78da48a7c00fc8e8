#ifndef SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
#define SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_

#include <memory>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/node_residuals.h"
#include "splitfusion/lib/energy/point_residuals.h"
#include "splitfusion/lib/energy/term_options.h"

namespace splitfusion {

struct ModelSample;
class WarpedPoints;
class WarpedPointsCache;

/// Scale s of the energy: residuals are compared with 1 cm, so that a weight
/// means the same in every frame and on every surface.
constexpr double kResidualUnit = 0.01;  // Unit: metres.

/// The residuals that one term has added.
struct TermResiduals {
  /// Warped points and their residuals; null if there are none.
  std::shared_ptr<const WarpedPoints> points;
  /// As `points`.
  std::shared_ptr<const PointResiduals> of_points;
  /// Residuals of node tuples; null if there are none.
  std::shared_ptr<const NodeResiduals> of_nodes;
};

/// Receives the residuals of one term. It owns the parameter layout: terms name
/// graph nodes.
class ResidualSink {
 public:
  /// Residuals are scaled so that their cost sums to
  /// options.weight / N * sum of rho(|r|^2 / s^2). Terms of one problem share
  /// `cache`.
  ResidualSink(const TermOptions& options, WarpedPointsCache* cache)
      : options_(options), cache_(cache) {}

  /// Adds one residual vector per model sample; `functors[i]` sees the warped
  /// point of `samples[i]`. PointFunctor: kResiduals, and a template
  /// operator()(const T* warped_point, T* residual) in metres. `total`: N, the
  /// sum of the weights that the functors carry; 0: every one weighs 1. Call it
  /// once.
  ///
  /// @throw InputError unless there is a functor for every sample, and every
  ///     sample is carried by nodes of the graph, ascending.
  template <typename PointFunctor>
  void AddWarpedPoints(const std::vector<const ModelSample*>& samples,
                       const std::vector<PointFunctor>& functors,
                       double total = 0) {
    Count(samples.size(), functors.size(), total);
    if (samples.empty()) return;
    std::vector<PointFunctor> ordered;
    ordered.reserve(functors.size());
    for (const int i : SetPoints(samples)) {
      ordered.push_back(functors[i]);
    }
    residuals_.of_points = std::make_shared<PointResidualsOf<PointFunctor>>(
        std::move(ordered), Scaling());
  }

  /// Adds one residual vector per tuple of different nodes; `functors[i]` sees
  /// the twists of `nodes[i]` as (T const* const* twists, T* residual), in
  /// metres. Plain autodiff; `total`: N, as of AddWarpedPoints(). Call it once.
  ///
  /// @throw InputError unless there is a functor for every tuple, and every
  ///     tuple has nodes of the graph, none of them twice.
  template <typename Functor>
  void AddNodes(const std::vector<std::vector<int>>& nodes,
                const std::vector<Functor>& functors, double total = 0) {
    Count(nodes.size(), functors.size(), total);
    if (nodes.empty()) return;
    CheckTuples(nodes);
    residuals_.of_nodes =
        std::make_shared<NodeResidualsOf<Functor>>(nodes, functors, Scaling());
  }

  /// Number of residual vectors.
  int residual_vectors() const { return residual_vectors_; }
  /// What has been added.
  const TermResiduals& residuals() const { return residuals_; }

 private:
  void CheckTuples(const std::vector<std::vector<int>>& nodes) const;

  /// The samples in the order in which their residuals are kept.
  const std::vector<int>& SetPoints(
      const std::vector<const ModelSample*>& samples);

  void Count(std::size_t vectors, std::size_t functors, double total);

  /// Its weight turns Ceres' 1/2 sum into the term's energy.
  ResidualScaling Scaling() const;

  const TermOptions& options_;
  WarpedPointsCache* cache_;
  int residual_vectors_ = 0;
  double total_ = 0;  // N of the normalisation.
  TermResiduals residuals_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
