#include "splitfusion/lib/evaluation/run_evaluation.h"

#include <algorithm>
#include <map>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/live_images.h"
#include "splitfusion/lib/evaluation/seen_score.h"
#include "splitfusion/lib/evaluation/true_occasion.h"

namespace splitfusion {
namespace {

TriangleMesh Transformed(TriangleMesh mesh, const Rigid3d& motion) {
  const Rigid3f motion_f = motion.cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = motion_f * vertex;
  return mesh;
}

void EvaluateBackground(const std::vector<AnimatedSurface>& surfaces,
                        const GroundTruth& truth,
                        const SurfaceErrorOptions& options,
                        RunEvaluation* result) {
  const auto found = std::find_if(
      surfaces.begin(), surfaces.end(),
      [](const AnimatedSurface& surface) { return surface.background(); });
  if (truth.static_mesh.empty()) {
    result->skipped.push_back("background surface: no static_mesh.ply");
  } else if (found == surfaces.end() || found->recorded().mesh.empty()) {
    result->skipped.push_back("background surface: the run has none");
  } else {
    const TriangleMesh mesh =
        Transformed(found->recorded().mesh,
                    result->trajectory->truth_from_estimate_by_poses);
    const TrueSurface scene = ReadTrueSurface(truth.static_mesh);
    result->background = CompareSurfaces(mesh, scene, options);
    result->ghosts = CountGhosts(mesh, scene.mesh);
  }
}

/// The live images, or none, and why.
std::optional<LiveImages> OpenLiveImages(const RecordedRun& run,
                                         RunEvaluation* result) {
  try {
    return LiveImages(run);
  } catch (const InputError& error) {
    result->skipped.push_back(
        std::string("stray area, presence and what was seen: ") + error.what());
    return std::nullopt;
  }
}

ModelInspection Inspect(const RecordedRun& run,
                        const std::vector<AnimatedSurface>& surfaces,
                        const std::optional<LiveImages>& live,
                        const GroundTruth& truth,
                        const EvaluationOptions& options,
                        RunEvaluation* result) {
  if (options.presence_every == 0) {
    result->skipped.push_back("presence, stretched area: not asked for");
    return {};
  }
  const InstanceLabels labels{truth.labels, truth.MovingInstances()};
  try {
    return InspectModels(run, surfaces, live ? &*live : nullptr, labels,
                         options.presence_every);
  } catch (const InputError& error) {
    result->skipped.push_back(std::string("stray area, presence: ") +
                              error.what());
    return InspectModels(run, surfaces, nullptr, labels,
                         options.presence_every);
  }
}

void AddSeenScores(const std::vector<AnimatedSurface>& surfaces,
                   const std::vector<TrueOccasion>& occasions,
                   const LiveImages& live, const GroundTruth& truth,
                   const EvaluationOptions& options, RunEvaluation* result) {
  std::map<int, SeenScore> scores;
  try {
    scores = ScoreSeen(surfaces, occasions, live, truth.labels,
                       options.presence.plain_view_pixels);
  } catch (const InputError& error) {
    result->skipped.push_back(std::string("F-score of what was seen: ") +
                              error.what());
  }
  for (InstanceError& instance : result->instances) {
    if (instance.rigid) continue;
    const auto found = scores.find(instance.instance);
    if (found != scores.end() && !found->second.frames.empty()) {
      instance.seen = found->second;
    }
  }
}

void SayWhatInstancesLack(const RecordedRun& run, const GroundTruth& truth,
                          bool occasions, RunEvaluation* result) {
  if (!occasions) {
    result->skipped.push_back(
        "instance surfaces: no mesh/instK_T.ply of a frame of the run");
    return;
  }
  if (truth.labels.empty() || !run.camera) {
    result->skipped.push_back(
        "view error of the instances: no label/ or no camera intrinsics");
  }
  for (const InstanceError& instance : result->instances) {
    if (instance.surface_id >= 0) continue;
    result->skipped.push_back("surface of instance " +
                              std::to_string(instance.instance) +
                              ": no surface of the run lies on it");
  }
}

/// The instances of the truth, and the shapes of all surfaces.
void EvaluateModels(const RecordedRun& run,
                    const std::vector<AnimatedSurface>& surfaces,
                    const GroundTruth& truth, const EvaluationOptions& options,
                    RunEvaluation* result) {
  const std::optional<LiveImages> live = OpenLiveImages(run, result);
  const ModelInspection inspection =
      Inspect(run, surfaces, live, truth, options, result);
  result->shapes = inspection.shapes;
  std::map<int, InstancePresence> presences;
  for (const auto& [instance, sightings] : inspection.sightings) {
    presences[instance] = JudgePresence(sightings, options.presence);
  }
  const std::vector<TrueOccasion> occasions = FindOccasions(run, truth);
  SurfaceErrorOptions surface = options.surface;
  surface.label.reset();  // A property of the static mesh.
  result->instances =
      CompareInstances(run, surfaces, truth, occasions, presences, surface);
  for (InstanceError& instance : result->instances) {
    for (const SurfaceShape& shape : result->shapes) {
      if (shape.surface_id == instance.surface_id) instance.shape = shape;
    }
  }
  if (live) {
    AddSeenScores(surfaces, occasions, *live, truth, options, result);
  }
}

void EvaluateDepth(const RecordedRun& run,
                   const std::vector<AnimatedSurface>& surfaces, int every,
                   int plain_view_pixels, RunEvaluation* result) {
  if (every == 0) {
    result->skipped.push_back("depth agreement: not asked for");
    return;
  }
  try {
    result->depth = CompareDepth(run, surfaces, every, plain_view_pixels);
  } catch (const InputError& error) {
    result->skipped.push_back(std::string("depth agreement: ") + error.what());
  }
}

void EvaluateAgainstTruth(const RecordedRun& run,
                          const std::vector<AnimatedSurface>& surfaces,
                          const GroundTruth& truth,
                          const EvaluationOptions& options,
                          RunEvaluation* result) {
  result->ground_truth = truth.folder;
  result->trajectory = CompareTrajectories(
      run.EstimatedTrajectory(), truth.trajectory, options.trajectory);
  EvaluateBackground(surfaces, truth, options.surface, result);
  EvaluateModels(run, surfaces, truth, options, result);
  SayWhatInstancesLack(run, truth, !truth.posed_meshes.empty(), result);
  result->track_references =
      EvaluateTracks(run, surfaces, truth, options.tracks, &result->skipped);
  if (!result->track_references.empty()) {
    result->tracks = MeanOf(result->track_references);
  }
}

}  // namespace

void EvaluationOptions::Check() const {
  trajectory.Check();
  surface.Check();
  tracks.Check();
  presence.Check();
  CheckOption(presence_every >= 0, "presence_every", presence_every,
              "a number of frames, or 0");
  CheckOption(depth_every >= 0, "depth_every", depth_every,
              "a number of frames, or 0");
}

RunEvaluation EvaluateRun(const RecordedRun& run,
                          const std::vector<AnimatedSurface>& surfaces,
                          const std::optional<GroundTruth>& truth,
                          const EvaluationOptions& options) {
  options.Check();
  RunEvaluation result;
  result.run = run.root;
  if (truth) {
    EvaluateAgainstTruth(run, surfaces, *truth, options, &result);
  } else {
    result.skipped.push_back(
        "trajectory, surfaces and tracks: no ground truth given");
    EvaluateModels(run, surfaces, GroundTruth(), options, &result);
  }
  EvaluateDepth(run, surfaces, options.depth_every,
                options.presence.plain_view_pixels, &result);
  return result;
}

}  // namespace splitfusion
