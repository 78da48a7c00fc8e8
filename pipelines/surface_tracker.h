#ifndef SPLITFUSION_PIPELINES_SURFACE_TRACKER_H_
#define SPLITFUSION_PIPELINES_SURFACE_TRACKER_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/association/association.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/pipelines/tracker_options.h"

namespace splitfusion {

/// Tracks one surface from model to frame (SplitFusion IV-C): alternates
/// association and minimisation of the energy, rigid first, then, if
/// the graph has more than one node, non-rigid with the prior annealed from
/// stiff to soft; coarse to fine over the image resolution.
class SurfaceTracker {
 public:
  /// @throw InputError if an option is out of its range or names what is not
  ///     registered.
  SurfaceTracker(TrackerOptions options, const SolverOptions& solver,
                 SurfaceEnergies energies,
                 AssociationRegistry associations = BuiltinAssociations(),
                 const SolverRegistry& solvers = BuiltinSolvers());

  /// Moves the graph, which comes in at the predicted motions, so that the
  /// samples lie on the live pixels of `surface`, and its points that were
  /// followed where they are seen, as far as the energy asks. `still` is the
  /// rigid motion of the camera frame that takes the prediction back to where
  /// the surface was: tracking starts there unless the prediction fits clearly
  /// better, so that a motion which the data do not determine does not carry
  /// itself on. A frame that fails leaves the graph where tracking started; the
  /// report says why. Returns whether it succeeded. `context`: for terms that
  /// ask for it; its class name decides which energy it is. `motions`: of its
  /// points, see PartStarter.
  bool Track(const std::vector<ModelSample>& samples,
             const std::vector<TrackedPoint>& tracks, const LiveView& live,
             std::uint16_t surface, const Rigid3d& still,
             DeformationGraph* graph, SurfaceReport* report,
             const TermContext& context = {},
             const std::vector<PointMotion>& motions = {}) const;

  /// What is minimised.
  const SurfaceEnergies& energies() const { return energies_; }

 private:
  /// What a surface is compared with in one frame.
  struct Target {
    const LiveView& live;
    std::uint16_t surface;
    const Associator& associator;
    const std::vector<TrackedPoint>& tracks;
    const Energy& energy;
    TermContext context;
    const std::vector<PointMotion>& motions;
  };

  double Misfit(const std::vector<ModelSample>& samples, const Target& target,
                const DeformationGraph& graph) const;
  /// `back`: the rigid motion of the camera frame from `start` to where the
  /// surface was.
  bool TrackFrom(const DeformationGraph& start, const Rigid3d& back,
                 const std::vector<ModelSample>& samples, const Target& target,
                 DeformationGraph* graph, SurfaceReport* report) const;
  /// The rigid stages that a surface of this graph goes through.
  std::vector<TrackingStage> RigidStagesOf(const DeformationGraph& graph) const;
  void TrackRigid(const std::vector<ModelSample>& samples, const Target& target,
                  const Rigid3d& back, DeformationGraph* graph,
                  SurfaceReport* report) const;
  /// Moves parts that moved far, and `before`, where each node was, with them;
  /// the point tracks that agree with that.
  std::vector<TrackedPoint> StartParts(const std::vector<ModelSample>& samples,
                                       const Target& target,
                                       DeformationGraph* before,
                                       DeformationGraph* graph,
                                       SurfaceReport* report) const;
  void TrackNonRigid(const std::vector<ModelSample>& samples,
                     const Target& target,
                     const std::vector<NodeMotion>& before,
                     DeformationGraph* graph, SurfaceReport* report) const;
  /// `stage`: of the samples; `facts`: of the round.
  bool RunRound(const std::vector<ModelSample>& samples, const Target& target,
                const TrackingStage& stage, const RoundFacts& facts,
                double anneal, const std::vector<NodeMotion>& before,
                DeformationGraph* graph, SurfaceReport* report) const;
  std::string ReasonForLoss(const Rigid3d& motion,
                            const SurfaceReport& report) const;
  std::string ReasonForMisfit(const SurfaceReport& report) const;

  TrackerOptions options_;
  std::vector<TrackingStage> rigid_stages_, non_rigid_stages_;
  AssociationRegistry associations_;
  std::unique_ptr<Solver> solver_;
  double initial_radius_;
  SurfaceEnergies energies_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_SURFACE_TRACKER_H_
