#include "splitfusion/lib/evaluation/evaluation_json.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/evaluation/headline.h"
#include "splitfusion/lib/evaluation/mean_error.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// Of kSurfaceThresholds, 20 mm: a pixel at which the model is right.
constexpr std::size_t kRightThreshold = 1;

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
          {"missing", view.MissingShare()},
          {"right", view.RightShare(kRightThreshold)},
          {"distances", DistancesJson(view.distances)}};
}

Json FrameJson(const InstanceFrameError& error) {
  Json json = {{"frame", error.frame}, {"missing", error.missing}};
  json["surface"] = error.matched ? ToJson(error.surface) : Json();
  json["view"] = error.view.pixels > 0 ? ViewJson(error.view) : Json();
  return json;
}

Json PresenceJson(const InstancePresence& presence) {
  return {{"surface_id",
           presence.surface_id >= 0 ? Json(presence.surface_id) : Json()},
          {"frames_in_view", presence.in_view.size()},
          {"frames_missing", presence.missing.size()},
          {"share", presence.MissingShare()},
          {"missing_frames", presence.missing}};
}

Json SeenJson(const SeenScore& seen) {
  Json frames = Json::array();
  for (const SeenFrame& item : seen.frames) {
    frames.push_back({{"frame", item.frame},
                      {"precision", item.precision},
                      {"recall", item.recall},
                      {"f_score", item.f_score}});
  }
  const SeenFrame mean = seen.Mean();
  return {{"surface_id", seen.surface_id >= 0 ? Json(seen.surface_id) : Json()},
          {"precision", mean.precision},
          {"recall", mean.recall},
          {"f_score", mean.f_score},
          {"by_frame", frames}};
}

/// NAME, NAME_worst, NAME_worst_frame.
void AddShares(const std::string& name,
               const std::optional<ShareOverFrames>& shares, Json* json) {
  const bool known = shares && shares->worst_frame >= 0;
  (*json)[name] = known ? Json(shares->mean) : Json();
  (*json)[name + "_worst"] = known ? Json(shares->worst) : Json();
  (*json)[name + "_worst_frame"] = known ? Json(shares->worst_frame) : Json();
}

void AddShape(const SurfaceShape& shape, Json* json) {
  AddShares("stretched", shape.stretched, json);
  (*json)["stretched_triangles"] = shape.stretched_triangles;
  (*json)["longest_edge"] = shape.longest_edge;
  AddShares("stray", shape.stray, json);
}

/// The figures of the surface of an instance: `surface` of its entry.
Json InstanceSurfaceJson(const InstanceError& error,
                         const InstanceMeans& means) {
  if (means.surface_frames == 0 && !error.seen && !error.shape) return {};
  Json json = ToJson(means.surface);
  if (means.surface_frames == 0) {
    for (Json& value : json) value = nullptr;
  }
  json["f_score_seen"] = error.seen ? Json(error.seen->Mean().f_score) : Json();
  AddShape(error.shape.value_or(SurfaceShape()), &json);
  return json;
}

Json InstanceJson(const InstanceError& error) {
  Json frames = Json::array();
  for (const InstanceFrameError& item : error.frames) {
    frames.push_back(FrameJson(item));
  }
  const InstanceMeans means = MeanOf(error);
  Json json = {{"instance", error.instance},
               {"name", error.name},
               {"rigid", error.rigid}};
  json["surface_id"] = error.surface_id >= 0 ? Json(error.surface_id) : Json();
  json["surface_label"] = error.surface_label;
  json["surface_frames"] = means.surface_frames;
  json["surface_frames_missing"] = means.frames_missing;
  json["presence"] = error.presence ? PresenceJson(*error.presence) : Json();
  json["surface"] = InstanceSurfaceJson(error, means);
  json["surface_where_shown"] = means.surface_frames > means.frames_missing
                                    ? ToJson(means.shown)
                                    : Json();
  json["seen"] = error.seen ? SeenJson(*error.seen) : Json();
  json["view"] = means.view.pixels > 0 ? ViewJson(means.view) : Json();
  json["frames"] = frames;
  return json;
}

Json ShapeJson(const SurfaceShape& shape) {
  Json json = {{"surface_id", shape.surface_id},
               {"surface_label", shape.surface_label},
               {"frames", shape.frames}};
  AddShape(shape, &json);
  return json;
}

Json HeadlineJson(const Headline& headline) {
  Json json;
  for (const HeadlineFigure& figure : kHeadlineFigures) {
    const std::optional<double>& value = headline.*figure.value;
    json[figure.name] = value ? Json(*value) : Json();
  }
  return json;
}

Json BackgroundJson(const RunEvaluation& evaluation) {
  if (!evaluation.background) return {};
  Json json = ToJson(*evaluation.background);
  json["ghosts"] =
      evaluation.ghosts ? Json(evaluation.ghosts->Share()) : Json();
  json["ghost_vertices"] =
      evaluation.ghosts ? Json(evaluation.ghosts->far) : Json();
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
  const int reference = tracks.errors.reference_frame;
  Json json = {{"reference_frame", reference >= 0 ? Json(reference) : Json()},
               {"frames", tracks.errors.frames},
               {"points", tracks.errors.points},
               {"attached", tracks.attached},
               {"unattached", tracks.unattached},
               {"by_mask", tracks.by_mask}};
  json.update(TrackJson(tracks.errors.all));
  json["instances"] = instances;
  return json;
}

/// The mean over the reference frames, and each of them.
Json AllTracksJson(const RunEvaluation& evaluation) {
  if (!evaluation.tracks) return {};
  Json json = TracksJson(*evaluation.tracks);
  Json references = Json::array();
  for (const TrackEvaluation& item : evaluation.track_references) {
    references.push_back(TracksJson(item));
  }
  json["by_reference"] = references;
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
          {"frames_missing", agreement.frames_missing},
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
  Json shapes = Json::array();
  for (const SurfaceShape& item : evaluation.shapes) {
    shapes.push_back(ShapeJson(item));
  }
  Json depth = Json::array();
  for (const DepthAgreement& item : evaluation.depth) {
    depth.push_back(DepthJson(item));
  }
  Json json = {{"run", evaluation.run}};
  json["ground_truth"] =
      evaluation.trajectory ? Json(evaluation.ground_truth) : Json();
  json["headline"] = HeadlineJson(HeadlineOf(evaluation));
  json["whole_model"] = evaluation.whole_model;
  json["with_unknown"] = true;  // Readers of older files ask for it.
  json.update(TrajectoryJson(evaluation.trajectory));
  json["background"] = BackgroundJson(evaluation);
  json["instances"] = instances;
  json["surfaces"] = shapes;
  json["tracks"] = AllTracksJson(evaluation);
  json["depth_agreement"] = depth;
  json["skipped"] = evaluation.skipped;
  return json;
}

}  // namespace splitfusion
