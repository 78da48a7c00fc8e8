#include "splitfusion/lib/evaluation/headline.h"

#include "splitfusion/lib/evaluation/mean_error.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"

namespace splitfusion {
namespace {

/// Mean of values as they come.
class PlainMean {
 public:
  void Add(double value) {
    sum_ += value;
    ++count_;
  }
  std::optional<double> Value() const {
    if (count_ == 0) return std::nullopt;
    return sum_ / count_;
  }

 private:
  double sum_ = 0;
  int count_ = 0;
};

void AddTrajectory(const TrajectoryError& error, Headline* headline) {
  headline->ate_m = error.absolute.rmse;
  for (const RelativePoseError& item : error.relative) {
    if (item.frames != 1) continue;
    headline->rpe_m = item.translation.rmse;
    headline->rpe_deg = item.rotation_degrees.rmse;
  }
}

void AddInstances(const std::vector<InstanceError>& instances,
                  Headline* headline) {
  PlainMean surface, seen, view, missing, stretched;
  for (const InstanceError& instance : instances) {
    if (instance.rigid) continue;
    const InstanceMeans means = MeanOf(instance);
    if (means.surface_frames > 0) {
      surface.Add(means.surface.accuracy.statistics.mean);
    }
    if (instance.seen) seen.Add(instance.seen->Mean().f_score);
    if (means.view_frames > 0) {
      view.Add(means.view.distances.statistics.mean);
      missing.Add(means.view.MissingShare());
    }
    if (instance.shape) stretched.Add(instance.shape->stretched.mean);
  }
  headline->surface_error_m = surface.Value();
  headline->f_score_seen = seen.Value();
  headline->view_error_m = view.Value();
  headline->missing = missing.Value();
  headline->stretched = stretched.Value();
}

std::optional<double> MeanStretch(const std::vector<SurfaceShape>& shapes) {
  PlainMean mean;
  for (const SurfaceShape& shape : shapes) {
    if (shape.frames > 0) mean.Add(shape.stretched.mean);
  }
  return mean.Value();
}

}  // namespace

Headline HeadlineOf(const RunEvaluation& evaluation) {
  Headline headline;
  if (evaluation.trajectory) AddTrajectory(*evaluation.trajectory, &headline);
  if (evaluation.tracks) {
    const ErrorStatistics& visible = evaluation.tracks->errors.all.visible;
    headline.tracks_mean_m = visible.mean;
    headline.tracks_median_m = visible.median;
  }
  AddInstances(evaluation.instances, &headline);
  if (evaluation.instances.empty()) {
    headline.stretched = MeanStretch(evaluation.shapes);
  }
  if (evaluation.ghosts) headline.ghosts = evaluation.ghosts->Share();
  return headline;
}

}  // namespace splitfusion
