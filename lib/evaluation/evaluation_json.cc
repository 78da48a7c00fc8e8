#include "splitfusion/lib/evaluation/evaluation_json.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/evaluation/mean_error.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

Json StatisticsJson(const ErrorStatistics& errors) {
  return {{"count", errors.count}, {"rmse", errors.rmse},
          {"mean", errors.mean},   {"median", errors.median},
          {"p90", errors.p90},     {"max", errors.max}};
}

/// {"0.01": value, ...} for each of kSurfaceThresholds.
Json ByThreshold(const std::array<double, kSurfaceThresholds.size()>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) {
    json[Json(kSurfaceThresholds[i]).dump()] = values[i];
  }
  return json;
}

Json DistancesJson(const SurfaceDistances& distances) {
  Json json = StatisticsJson(distances.statistics);
  json["within"] = ByThreshold(distances.within);
  return json;
}

Json PoseJson(const Rigid3d& pose) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

Json ViewJson(const ViewError& view) {
  return {{"pixels", view.pixels},
          {"uncovered", view.uncovered},
          {"distances", DistancesJson(view.distances)}};
}

Json FrameJson(const InstanceFrameError& error) {
  Json json = {{"frame", error.frame}};
  json["surface"] = error.matched ? ToJson(error.surface) : Json();
  json["view"] = error.view.pixels > 0 ? ViewJson(error.view) : Json();
  return json;
}

Json InstanceJson(const InstanceError& error) {
  Json frames = Json::array();
  for (const InstanceFrameError& item : error.frames) {
    frames.push_back(FrameJson(item));
  }
  const InstanceMeans means = MeanOf(error);
  Json json = {{"instance", error.instance}, {"name", error.name}};
  json["surface_id"] = error.surface_id >= 0 ? Json(error.surface_id) : Json();
  json["surface_label"] = error.surface_label;
  json["surface_frames"] = means.surface_frames;
  json["surface"] = means.surface_frames > 0 ? ToJson(means.surface) : Json();
  json["view"] = means.view.pixels > 0 ? ViewJson(means.view) : Json();
  json["frames"] = frames;
  return json;
}

Json TrackJson(const TrackError& error) {
  return {{"visible", StatisticsJson(error.visible)},
          {"occluded", StatisticsJson(error.occluded)},
          {"still_world_visible", StatisticsJson(error.still_world)},
          {"rigid_visible", StatisticsJson(error.rigid)}};
}

Json TracksJson(const TrackEvaluation& tracks) {
  Json instances = Json::array();
  for (const auto& [instance, error] : tracks.errors.instances) {
    Json item = {{"instance", instance}};
    item.update(TrackJson(error));
    instances.push_back(item);
  }
  Json json = {{"reference_frame", tracks.errors.reference_frame},
               {"frames", tracks.errors.frames},
               {"points", tracks.errors.points},
               {"attached", tracks.attached},
               {"unattached", tracks.unattached},
               {"by_mask", tracks.by_mask}};
  json.update(TrackJson(tracks.errors.all));
  json["instances"] = instances;
  return json;
}

/// The keys of a trajectory error, all null if there is none.
Json TrajectoryJson(const std::optional<TrajectoryError>& error) {
  Json json = ToJson(error.value_or(TrajectoryError()));
  if (error) return json;
  for (Json& value : json) value = nullptr;
  return json;
}

Json DepthJson(const DepthAgreement& agreement) {
  return {{"surface_id", agreement.surface_id},
          {"surface_label", agreement.surface_label},
          {"frames", agreement.frames},
          {"pixels", agreement.pixels},
          {"uncovered", agreement.uncovered},
          {"other_surface", agreement.other_surface},
          {"uncovered_fraction", agreement.UncoveredFraction()},
          {"distances", StatisticsJson(agreement.distances)}};
}

}  // namespace

Json ToJson(const TrajectoryError& error) {
  Json relative = Json::array();
  for (const RelativePoseError& item : error.relative) {
    relative.push_back(
        {{"frames", item.frames},
         {"translation", StatisticsJson(item.translation)},
         {"rotation_degrees", StatisticsJson(item.rotation_degrees)}});
  }
  return {{"matched", error.matched},
          {"estimated_poses", error.estimated_poses},
          {"true_poses", error.true_poses},
          {"path_length", error.path_length},
          {"ate", StatisticsJson(error.absolute)},
          {"rpe", relative},
          {"truth_from_estimate", PoseJson(error.truth_from_estimate)},
          {"truth_from_estimate_by_poses",
           PoseJson(error.truth_from_estimate_by_poses)}};
}

Json ToJson(const SurfaceError& error) {
  return {{"accuracy", DistancesJson(error.accuracy)},
          {"completeness", DistancesJson(error.completeness)},
          {"f_score", ByThreshold(error.f_score)}};
}

Json ToJson(const RunEvaluation& evaluation) {
  Json instances = Json::array();
  for (const InstanceError& item : evaluation.instances) {
    instances.push_back(InstanceJson(item));
  }
  Json depth = Json::array();
  for (const DepthAgreement& item : evaluation.depth) {
    depth.push_back(DepthJson(item));
  }
  Json json = {{"run", evaluation.run}};
  json["ground_truth"] =
      evaluation.trajectory ? Json(evaluation.ground_truth) : Json();
  json["whole_model"] = evaluation.whole_model;
  json["with_unknown"] = evaluation.with_unknown;
  json.update(TrajectoryJson(evaluation.trajectory));
  json["background"] =
      evaluation.background ? ToJson(*evaluation.background) : Json();
  json["instances"] = instances;
  json["tracks"] = evaluation.tracks ? TracksJson(*evaluation.tracks) : Json();
  json["depth_agreement"] = depth;
  json["skipped"] = evaluation.skipped;
  return json;
}

void WriteJson(const std::string& path, const Json& value) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << value.dump(2, ' ', /*ensure_ascii=*/false,
                      Json::error_handler_t::replace)
        << '\n';
  });
}

}  // namespace splitfusion
