#include "splitfusion/lib/evaluation/evaluation_json.h"

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/evaluation/headline.h"
#include "splitfusion/lib/evaluation/mean_error.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"

namespace splitfusion {

using Json = nlohmann::ordered_json;

// By to_json() the library makes values of these types, and of lists of them.

namespace {

/// Of kSurfaceThresholds, 20 mm: a pixel at which the model is right.
constexpr std::size_t kRightThreshold = 1;

/// {"0.01": value, ...} for each of kSurfaceThresholds.
Json ByThreshold(const std::array<double, kSurfaceThresholds.size()>& values) {
  Json json = Json::object();
  for (std::size_t i = 0; i < values.size(); ++i) {
    json[Json(kSurfaceThresholds[i]).dump()] = values[i];
  }
  return json;
}

Json PoseJson(const Rigid3d& pose) {
  const Eigen::Vector3d t = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

/// An id or a number of a frame; negative = none.
Json IdOrNull(int id) { return id >= 0 ? Json(id) : Json(); }

template <typename T>
Json OrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

/// The same keys without values.
Json AllNull(Json json) {
  for (Json& value : json) value = nullptr;
  return json;
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

}  // namespace

void to_json(Json& json, const ErrorStatistics& errors) {
  json = {{"count", errors.count}, {"rmse", errors.rmse},
          {"mean", errors.mean},   {"median", errors.median},
          {"p90", errors.p90},     {"max", errors.max}};
}

void to_json(Json& json, const SurfaceDistances& distances) {
  json = distances.statistics;
  json["within"] = ByThreshold(distances.within);
}

void to_json(Json& json, const SurfaceError& error) {
  json = {{"accuracy", error.accuracy},
          {"completeness", error.completeness},
          {"f_score", ByThreshold(error.f_score)}};
}

void to_json(Json& json, const ViewError& view) {
  json = {{"pixels", view.pixels},
          {"uncovered", view.uncovered},
          {"missing", view.MissingShare()},
          {"right", view.RightShare(kRightThreshold)},
          {"distances", view.distances}};
}

void to_json(Json& json, const InstanceFrameError& error) {
  json = {{"frame", error.frame}, {"missing", error.missing}};
  json["surface"] = error.matched ? Json(error.surface) : Json();
  json["view"] = error.view.pixels > 0 ? Json(error.view) : Json();
}

void to_json(Json& json, const InstancePresence& presence) {
  json = {{"surface_id", IdOrNull(presence.surface_id)},
          {"frames_in_view", presence.in_view.size()},
          {"frames_missing", presence.missing.size()},
          {"share", presence.MissingShare()},
          {"missing_frames", presence.missing}};
}

void to_json(Json& json, const SeenFrame& seen) {
  json = {{"frame", seen.frame},
          {"precision", seen.precision},
          {"recall", seen.recall},
          {"f_score", seen.f_score}};
}

void to_json(Json& json, const SeenScore& seen) {
  const SeenFrame mean = seen.Mean();
  json = {{"surface_id", IdOrNull(seen.surface_id)},
          {"precision", mean.precision},
          {"recall", mean.recall},
          {"f_score", mean.f_score},
          {"by_frame", seen.frames}};
}

namespace {

/// The figures of the surface of an instance: `surface` of its entry.
Json InstanceSurfaceJson(const InstanceError& error,
                         const InstanceMeans& means) {
  if (means.surface_frames == 0 && !error.seen && !error.shape) return {};
  Json json = means.surface;
  if (means.surface_frames == 0) json = AllNull(json);
  json["f_score_seen"] = error.seen ? Json(error.seen->Mean().f_score) : Json();
  AddShape(error.shape.value_or(SurfaceShape()), &json);
  return json;
}

}  // namespace

void to_json(Json& json, const InstanceError& error) {
  const InstanceMeans means = MeanOf(error);
  json = {{"instance", error.instance},
          {"name", error.name},
          {"rigid", error.rigid},
          {"surface_id", IdOrNull(error.surface_id)},
          {"surface_label", error.surface_label},
          {"surface_frames", means.surface_frames},
          {"surface_frames_missing", means.frames_missing},
          {"presence", OrNull(error.presence)},
          {"surface", InstanceSurfaceJson(error, means)}};
  json["surface_where_shown"] =
      means.surface_frames > means.frames_missing ? Json(means.shown) : Json();
  json["seen"] = OrNull(error.seen);
  json["view"] = means.view.pixels > 0 ? Json(means.view) : Json();
  json["frames"] = error.frames;
}

void to_json(Json& json, const SurfaceShape& shape) {
  json = {{"surface_id", shape.surface_id},
          {"surface_label", shape.surface_label},
          {"frames", shape.frames}};
  AddShape(shape, &json);
}

void to_json(Json& json, const Headline& headline) {
  for (const HeadlineFigure& figure : kHeadlineFigures) {
    json[figure.name] = OrNull(headline.*figure.value);
  }
}

void to_json(Json& json, const TrackError& error) {
  json = {{"visible", error.visible},
          {"occluded", error.occluded},
          {"still_world_visible", error.still_world},
          {"rigid_visible", error.rigid}};
}

void to_json(Json& json, const TrackEvaluation& tracks) {
  Json instances = Json::array();
  for (const auto& [instance, error] : tracks.errors.instances) {
    Json item = {{"instance", instance}};
    item.update(Json(error));
    instances.push_back(item);
  }
  json = {{"reference_frame", IdOrNull(tracks.errors.reference_frame)},
          {"frames", tracks.errors.frames},
          {"points", tracks.errors.points},
          {"attached", tracks.attached},
          {"unattached", tracks.unattached},
          {"by_mask", tracks.by_mask}};
  json.update(Json(tracks.errors.all));
  json["instances"] = instances;
}

void to_json(Json& json, const DepthAgreement& agreement) {
  json = {{"surface_id", agreement.surface_id},
          {"surface_label", agreement.surface_label},
          {"frames", agreement.frames},
          {"frames_missing", agreement.frames_missing},
          {"pixels", agreement.pixels},
          {"uncovered", agreement.uncovered},
          {"other_surface", agreement.other_surface},
          {"uncovered_fraction", agreement.UncoveredFraction()},
          {"distances", agreement.distances}};
}

void to_json(Json& json, const RelativePoseError& error) {
  json = {{"frames", error.frames},
          {"translation", error.translation},
          {"rotation_degrees", error.rotation_degrees}};
}

namespace {

Json BackgroundJson(const RunEvaluation& evaluation) {
  Json json = OrNull(evaluation.background);
  if (!evaluation.background) return json;
  const std::optional<Ghosts>& ghosts = evaluation.ghosts;
  json["ghosts"] = ghosts ? Json(ghosts->Share()) : Json();
  json["ghost_vertices"] = ghosts ? Json(ghosts->far) : Json();
  return json;
}

/// The mean over the reference frames, and each of them.
Json AllTracksJson(const RunEvaluation& evaluation) {
  Json json = OrNull(evaluation.tracks);
  if (evaluation.tracks) json["by_reference"] = evaluation.track_references;
  return json;
}

}  // namespace

Json ToJson(const TrajectoryError& error) {
  return {{"matched", error.matched},
          {"estimated_poses", error.estimated_poses},
          {"true_poses", error.true_poses},
          {"path_length", error.path_length},
          {"ate", error.absolute},
          {"rpe", error.relative},
          {"truth_from_estimate", PoseJson(error.truth_from_estimate)},
          {"truth_from_estimate_by_poses",
           PoseJson(error.truth_from_estimate_by_poses)}};
}

Json ToJson(const SurfaceError& error) { return error; }

Json ToJson(const RunEvaluation& evaluation) {
  const Json trajectory =
      ToJson(evaluation.trajectory.value_or(TrajectoryError()));
  Json json = {{"run", evaluation.run}};
  json["ground_truth"] =
      evaluation.trajectory ? Json(evaluation.ground_truth) : Json();
  json["headline"] = HeadlineOf(evaluation);
  json["whole_model"] = evaluation.whole_model;
  json["with_unknown"] = true;  // Readers of older files ask for it.
  json.update(evaluation.trajectory ? trajectory : AllNull(trajectory));
  json["background"] = BackgroundJson(evaluation);
  json["instances"] = evaluation.instances;
  json["surfaces"] = evaluation.shapes;
  json["tracks"] = AllTracksJson(evaluation);
  json["depth_agreement"] = evaluation.depth;
  json["skipped"] = evaluation.skipped;
  return json;
}

}  // namespace splitfusion
