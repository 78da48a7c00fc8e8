#include "splitfusion/lib/evaluation/run_evaluation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// Largest difference of a run's frame from the true pose of that index.
constexpr double kMaxTimeDifference = 0.02;

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
    result->background = CompareSurfaces(
        Transformed(found->recorded().mesh,
                    result->trajectory->truth_from_estimate_by_poses),
        ReadTrueSurface(truth.static_mesh), options);
  }
}

void EvaluateInstances(const RecordedRun& run,
                       const std::vector<AnimatedSurface>& surfaces,
                       const GroundTruth& truth, SurfaceErrorOptions options,
                       RunEvaluation* result) {
  // `seen` and `label` are properties of the static mesh.
  options.label.reset();
  result->instances = CompareInstances(run, surfaces, truth, options);
  if (result->instances.empty()) {
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

/// The frame in which most points are visible and that has `frames` successors
/// in the run and in the tracks; -1 if no point is visible in any.
int BestTrackFrame(const RecordedRun& run, const TrueTracks& tracks,
                   int frames) {
  int best = -1;
  int best_count = 0;
  for (int f = 0; f + frames < tracks.frames(); ++f) {
    const int count = tracks.VisibleCount(f);
    if (count > best_count && run.Find(f) != nullptr &&
        run.Find(f + frames) != nullptr) {
      best = f;
      best_count = count;
    }
  }
  return best;
}

/// Why the true tracks cannot be followed from `frame`; empty if they can.
std::string TrackObstacle(const RecordedRun& run, const GroundTruth& truth,
                          const TrueTracks& tracks, int frame) {
  const RecordedFrame* found = run.Find(frame);
  const int true_frames =
      std::min(tracks.frames(), static_cast<int>(truth.trajectory.size()));
  const std::string name = "frame " + std::to_string(frame);
  if (found == nullptr) return name + " is not in the run";
  if (frame < 0 || frame >= true_frames) return name + " has no truth";
  const double difference =
      std::abs(found->pose.timestamp - truth.trajectory[frame].timestamp);
  if (difference > kMaxTimeDifference) {
    return name + " of the run and of the truth differ by " +
           std::to_string(difference) + " s";
  }
  if (tracks.VisibleCount(frame) == 0) return "no point visible in " + name;
  return "";
}

std::vector<Rigid3d> TruePoses(const GroundTruth& truth) {
  std::vector<Rigid3d> poses;
  for (const TimedPose& pose : truth.trajectory) {
    poses.push_back(pose.world_from_camera);
  }
  return poses;
}

void EvaluateTracks(const RecordedRun& run,
                    const std::vector<AnimatedSurface>& surfaces,
                    const GroundTruth& truth, const EvaluationOptions& options,
                    RunEvaluation* result) {
  if (truth.tracks.empty()) {
    result->skipped.push_back("track error: no tracks.bin");
    return;
  }
  const TrueTracks tracks = TrueTracks::Read(truth.tracks);
  const int frame =
      options.track_frame >= 0
          ? options.track_frame
          : std::max(BestTrackFrame(run, tracks, options.track_frames), 0);
  const std::string obstacle = TrackObstacle(run, truth, tracks, frame);
  if (!obstacle.empty()) {
    result->skipped.push_back("track error: " + obstacle);
    return;
  }
  const std::vector<Rigid3d> poses = TruePoses(truth);
  const int last = std::min(frame + options.track_frames, tracks.frames() - 1);
  const FollowedPoints followed =
      FollowPoints(run, surfaces, tracks.Queries(frame, poses[frame]),
                   last - frame, options.attachment);
  result->tracks = {CompareTracks(followed.points, tracks, poses, frame),
                    followed.attached, followed.unattached, followed.by_mask};
}

void EvaluateDepth(const RecordedRun& run,
                   const std::vector<AnimatedSurface>& surfaces, int every,
                   RunEvaluation* result) {
  if (every == 0) {
    result->skipped.push_back("depth agreement: not asked for");
    return;
  }
  try {
    result->depth = CompareDepth(run, surfaces, every);
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
  EvaluateInstances(run, surfaces, truth, options.surface, result);
  EvaluateTracks(run, surfaces, truth, options, result);
}

}  // namespace

void EvaluationOptions::Check() const {
  trajectory.Check();
  surface.Check();
  attachment.Check();
  CheckOption(track_frame >= -1, "track_frame", track_frame,
              "a frame index, or -1");
  CheckOption(track_frames >= 1 && track_frames <= 1000000, "track_frames",
              track_frames, "1..1000000");
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
  }
  EvaluateDepth(run, surfaces, options.depth_every, &result);
  return result;
}

}  // namespace splitfusion
