#ifndef SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
#define SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_

#include <memory>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/node_residuals.h"
#include "splitfusion/lib/energy/point_residuals.h"
#include "splitfusion/lib/energy/term_options.h"
#include "splitfusion/lib/energy/unknown_residuals.h"

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
  /// Residuals of the term's own unknowns alone; null if there are none.
  std::shared_ptr<const UnknownResiduals> of_unknowns;
};

/// Receives the residuals of one term. It owns the parameter layout: terms name
/// graph nodes.
class ResidualSink {
 public:
  /// Residuals are scaled so that their cost sums to
  /// options.weight / N * sum of rho(|r|^2 / s^2). Terms of one problem share
  /// `cache`. `scales`: of the term's own unknowns.
  ResidualSink(const TermOptions& options, WarpedPointsCache* cache,
               std::vector<double> scales = {})
      : options_(options), cache_(cache), scales_(std::move(scales)) {}

  /// Adds one residual vector per model sample; `functors[i]` sees the warped
  /// point of `samples[i]`. PointFunctor: kResiduals, and a template
  /// operator()(const T* warped_point, T* residual) in metres. `total`: N, the
  /// sum of the weights that the functors carry; 0: every one weighs 1. Call it
  /// once.
  ///
  /// A functor with a constant kUnknowns sees the term's own unknowns as well,
  /// by (const T* warped_point, const T* unknowns, T* residual).
  ///
  /// @throw InputError unless there is a functor for every sample, and every
  ///     sample is carried by nodes of the graph, ascending; if `total` is
  ///     below 0 or not finite, or at the second call; OptionError if a functor
  ///     has other unknowns than the term declares.
  template <typename PointFunctor>
  void AddWarpedPoints(const std::vector<const ModelSample*>& samples,
                       const std::vector<PointFunctor>& functors,
                       double total = 0) {
    DemandFirst("AddWarpedPoints()", has_points_);
    Count(samples.size(), functors.size(), total);
    if (!samples.empty()) {
      std::vector<PointFunctor> ordered;
      ordered.reserve(functors.size());
      for (const int i : SetPoints(samples)) {
        ordered.push_back(functors[i]);
      }
      residuals_.of_points = MakePointResiduals(std::move(ordered));
    }
    has_points_ = true;
  }

  /// Adds one residual vector per tuple of different nodes; `functors[i]` sees
  /// the twists of `nodes[i]` as (T const* const* twists, T* residual), in
  /// metres. Plain autodiff; `total`: N, as of AddWarpedPoints(). Call it once.
  ///
  /// @throw InputError unless there is a functor for every tuple, and every
  ///     tuple has nodes of the graph, none of them twice; as AddWarpedPoints()
  ///     on `total` and the second call.
  template <typename Functor>
  void AddNodes(const std::vector<std::vector<int>>& nodes,
                const std::vector<Functor>& functors, double total = 0) {
    DemandFirst("AddNodes()", has_nodes_);
    Count(nodes.size(), functors.size(), total);
    if (!nodes.empty()) {
      CheckTuples(nodes);
      residuals_.of_nodes = std::make_shared<NodeResidualsOf<Functor>>(
          nodes, functors, Scaling());
    }
    has_nodes_ = true;
  }

  /// Adds one residual vector of the term's own unknowns alone per functor,
  /// which has constants kResiduals and kUnknowns and sees them as (const T*
  /// unknowns, T* residual), in metres: priors, which no loss is applied to. N
  /// is that of the residuals added before, if there are any: each weighs as
  /// much as one of these of weight 1. Call it once.
  ///
  /// @throw OptionError if it has others than the term declares; InputError at
  ///     the second call.
  template <typename Functor>
  void AddUnknowns(const std::vector<Functor>& functors) {
    DemandFirst("AddUnknowns()", has_unknowns_);
    CheckUnknowns(Functor::kUnknowns);
    has_unknowns_ = true;
    if (functors.empty()) return;
    const double own = static_cast<double>(functors.size());
    residuals_.of_unknowns = std::make_shared<UnknownResidualsOf<Functor>>(
        functors, scales_, Units(total_ > 0 ? total_ : own));
  }

  /// Number of residual vectors, without those of the unknowns alone.
  int residual_vectors() const { return residual_vectors_; }
  /// What has been added.
  const TermResiduals& residuals() const { return residuals_; }

 private:
  /// @throw InputError at the second call of a member.
  static void DemandFirst(const char* member, bool called);

  void CheckTuples(const std::vector<std::vector<int>>& nodes) const;

  template <typename PointFunctor>
  std::shared_ptr<const PointResiduals> MakePointResiduals(
      std::vector<PointFunctor> functors) const {
    if constexpr (internal::UnknownsOf<PointFunctor>::kCount == 0) {
      return std::make_shared<PointResidualsOf<PointFunctor>>(
          std::move(functors), Scaling());
    } else {
      CheckUnknowns(PointFunctor::kUnknowns);
      return std::make_shared<PointResidualsWithUnknownsOf<PointFunctor>>(
          std::move(functors), scales_, Scaling());
    }
  }

  /// @throw OptionError unless the term declares so many unknowns.
  void CheckUnknowns(int count) const;

  /// The samples in the order in which their residuals are kept.
  const std::vector<int>& SetPoints(
      const std::vector<const ModelSample*>& samples);

  void Count(std::size_t vectors, std::size_t functors, double total);

  /// Units and weight of residuals with the normalisation N = `total`. The
  /// weight turns Ceres' 1/2 sum into the term's energy.
  ResidualScaling Units(double total) const;
  /// Those of what was counted last, with the loss.
  ResidualScaling Scaling() const;

  const TermOptions& options_;
  WarpedPointsCache* cache_;
  std::vector<double> scales_;  // Of the unknowns.
  bool has_points_ = false;
  bool has_nodes_ = false;
  bool has_unknowns_ = false;
  int residual_vectors_ = 0;
  double total_ = 0;  // N of the normalisation.
  TermResiduals residuals_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_RESIDUAL_SINK_H_
