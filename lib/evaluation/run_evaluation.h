#ifndef SPLITFUSION_LIB_EVALUATION_RUN_EVALUATION_H_
#define SPLITFUSION_LIB_EVALUATION_RUN_EVALUATION_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/depth_agreement.h"
#include "splitfusion/lib/evaluation/ghosts.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/instance_error.h"
#include "splitfusion/lib/evaluation/model_inspection.h"
#include "splitfusion/lib/evaluation/presence.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/evaluation/surface_error.h"
#include "splitfusion/lib/evaluation/track_evaluation.h"
#include "splitfusion/lib/evaluation/trajectory_error.h"

namespace splitfusion {

/// How a run is evaluated.
struct EvaluationOptions {
  TrajectoryErrorOptions trajectory;  ///< ATE, RPE.
  SurfaceErrorOptions surface;        ///< Background and instances.
  TrackOptions tracks;                ///< Track error.
  PresenceOptions presence;           ///< Of instances.
  /// Presence, stretched and stray area are looked at in every n-th frame; 0 =
  /// not at all.
  int presence_every = 1;
  /// Depth agreement is measured in every n-th frame; 0 = not at all.
  int depth_every = 10;

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// All that a run can be measured by. What is empty was not known; `skipped`
/// says why.
struct RunEvaluation {
  std::string run;           ///< The run directory.
  std::string ground_truth;  ///< Folder of groundtruth.txt; empty if none.
  /// Set by the caller that cleared DeformationGraph::first_seen: the model of
  /// every frame was the whole final one.
  bool whole_model = false;
  std::optional<TrajectoryError> trajectory;  ///< ATE, RPE, alignment.
  /// The background's mesh, put into the true world by
  /// TrajectoryError::truth_from_estimate_by_poses.
  std::optional<SurfaceError> background;
  std::optional<Ghosts> ghosts;           ///< Of the same mesh.
  std::vector<InstanceError> instances;   ///< By instance.
  std::vector<SurfaceShape> shapes;       ///< By surface; no truth needed.
  std::optional<TrackEvaluation> tracks;  ///< Mean over the reference frames.
  std::vector<TrackEvaluation> track_references;  ///< Each of them.
  std::vector<DepthAgreement> depth;  ///< With the live depth; by id.
  std::vector<std::string> skipped;   ///< What was not evaluated, and why.
};

/// Evaluates a run without tracking again. `surfaces`: those of `run`; without
/// `truth` by the depth agreement and the surfaces' shapes alone. That,
/// presence and what was seen need the sequence, which may be gone: what is
/// wrong with it is a line of `skipped`.
///
/// @throw InputError if fewer than three poses match, or if a file of the
///     ground truth is broken.
RunEvaluation EvaluateRun(const RecordedRun& run,
                          const std::vector<AnimatedSurface>& surfaces,
                          const std::optional<GroundTruth>& truth,
                          const EvaluationOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_RUN_EVALUATION_H_
