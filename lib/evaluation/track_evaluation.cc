#include "splitfusion/lib/evaluation/track_evaluation.h"

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/mean_error.h"
#include "splitfusion/lib/evaluation/point_follower.h"
#include "splitfusion/lib/evaluation/true_tracks.h"

namespace splitfusion {
namespace {

/// A frame in which points are given, and how far they are followed.
struct Reference {
  int frame = 0;
  int frames = 0;
};

/// The frame in which most points are visible and that has `frames` successors
/// in the run and in the tracks; -1 if no point is visible in any.
int BestFrame(const RecordedRun& run, const TrueTracks& tracks, int frames) {
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

/// See TrackOptions::references.
Reference BestReference(const RecordedRun& run, const TrueTracks& tracks,
                        int frames) {
  const int last = std::min(run.frames.back().index, tracks.frames() - 1);
  if (last < frames) frames = std::max(1, last / 2);
  for (; frames > 1; frames /= 2) {
    const int best = BestFrame(run, tracks, frames);
    if (best >= 0) return {best, frames};
  }
  return {std::max(BestFrame(run, tracks, 1), 0), 1};
}

std::vector<Reference> References(const RecordedRun& run,
                                  const TrueTracks& tracks,
                                  const TrackOptions& options) {
  if (options.references.empty()) {
    return {BestReference(run, tracks, options.frames)};
  }
  std::vector<Reference> references;
  for (const int frame : options.references) {
    references.push_back(
        {frame, std::min(options.frames, tracks.frames() - 1 - frame)});
  }
  return references;
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

/// One of the four statistics over several track errors.
ErrorStatistics MeanOf(const std::vector<TrackError>& errors,
                       ErrorStatistics TrackError::*member) {
  std::vector<ErrorStatistics> items;
  for (const TrackError& error : errors) items.push_back(error.*member);
  return MeanOf(items);
}

TrackError MeanOf(const std::vector<TrackError>& errors) {
  return {MeanOf(errors, &TrackError::visible),
          MeanOf(errors, &TrackError::occluded),
          MeanOf(errors, &TrackError::still_world),
          MeanOf(errors, &TrackError::rigid)};
}

}  // namespace

void TrackOptions::Check() const {
  for (const int frame : references) {
    CheckOption(frame >= 0, "track_frame", frame, "a frame index");
  }
  CheckOption(frames >= 1 && frames <= 1000000, "track_frames", frames,
              "1..1000000");
}

std::vector<TrackEvaluation> EvaluateTracks(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const TrackOptions& options,
    std::vector<std::string>* skipped) {
  std::vector<TrackEvaluation> result;
  if (truth.tracks.empty()) {
    skipped->push_back("track error: no tracks.bin");
    return result;
  }
  const TrueTracks tracks = TrueTracks::Read(truth.tracks);
  const std::vector<Rigid3d> poses = TruePoses(truth);
  for (const Reference& reference : References(run, tracks, options)) {
    const int frame = reference.frame;
    const std::string obstacle = TrackObstacle(run, truth, tracks, frame);
    if (!obstacle.empty()) {
      skipped->push_back("track error: " + obstacle);
      continue;
    }
    const FollowedPoints followed = FollowPoints(
        run, surfaces, tracks.Queries(frame, poses[frame]), reference.frames);
    result.push_back({CompareTracks(followed.points, tracks, poses, frame),
                      followed.attached, followed.unattached,
                      followed.by_mask});
  }
  return result;
}

TrackEvaluation MeanOf(const std::vector<TrackEvaluation>& references) {
  if (references.size() == 1) return references.front();
  TrackEvaluation mean;
  mean.errors.reference_frame = -1;
  std::vector<TrackError> all;
  std::map<int, std::vector<TrackError>> instances;
  for (const TrackEvaluation& item : references) {
    mean.attached += item.attached;
    mean.unattached += item.unattached;
    mean.by_mask = mean.by_mask || item.by_mask;
    mean.errors.frames = std::max(mean.errors.frames, item.errors.frames);
    mean.errors.points += item.errors.points;
    all.push_back(item.errors.all);
    for (const auto& [instance, error] : item.errors.instances) {
      instances[instance].push_back(error);
    }
  }
  mean.errors.all = MeanOf(all);
  for (const auto& [instance, errors] : instances) {
    mean.errors.instances[instance] = MeanOf(errors);
  }
  return mean;
}

}  // namespace splitfusion
