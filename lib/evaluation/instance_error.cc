#include "splitfusion/lib/evaluation/instance_error.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/model_view.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

/// Of a true mesh or pose from a frame, seconds.
constexpr double kMaxTimeDifference = 0.02;
/// Samples that suffice to tell which surface is which instance.
constexpr int kMatchingSamples = 2000;

/// A true mesh together with the frame of the run it belongs to.
struct Occasion {
  int instance = 0;
  const RecordedFrame* frame = nullptr;
  Rigid3d world_from_camera;  ///< True pose.
  TrueSurface truth;          ///< World frame.
};

const RecordedFrame* FrameAt(const RecordedRun& run, double timestamp) {
  const RecordedFrame* best = nullptr;
  double best_difference = kMaxTimeDifference;
  for (const RecordedFrame& frame : run.frames) {
    const double difference = std::abs(frame.pose.timestamp - timestamp);
    if (difference <= best_difference) {
      best = &frame;
      best_difference = difference;
    }
  }
  return best;
}

std::optional<Rigid3d> TruePoseAt(const GroundTruth& truth, double timestamp) {
  std::optional<Rigid3d> best;
  double best_difference = kMaxTimeDifference;
  for (const TimedPose& pose : truth.trajectory) {
    const double difference = std::abs(pose.timestamp - timestamp);
    if (difference <= best_difference) {
      best = pose.world_from_camera;
      best_difference = difference;
    }
  }
  return best;
}

void CheckSize(const std::string& path, const cv::Size& size,
               const PinholeCamera& camera) {
  const cv::Size expected(camera.width, camera.height);
  if (size != expected) {
    throw InputError(path + ": " + ToString(size) + " pixels: expected " +
                     ToString(expected));
  }
}

std::vector<Occasion> FindOccasions(const RecordedRun& run,
                                    const GroundTruth& truth) {
  std::vector<Occasion> occasions;
  for (const PosedMeshFile& file : truth.posed_meshes) {
    const RecordedFrame* frame = FrameAt(run, file.timestamp);
    const auto pose = TruePoseAt(truth, file.timestamp);
    if (frame == nullptr || !pose) continue;
    occasions.push_back(
        {file.instance, frame, *pose, ReadTrueSurface(file.path)});
  }
  return occasions;
}

TriangleMesh ModelInWorld(const AnimatedSurface& surface,
                          const Occasion& occasion) {
  TriangleMesh mesh;
  mesh.triangles = surface.TrianglesAt(occasion.frame->index);
  // Without triangles it would be taken for a cloud of all its vertices.
  if (mesh.triangles.empty()) return mesh;
  mesh.vertices = surface.VerticesAt(occasion.frame->index);
  const Rigid3f world_from_camera = occasion.world_from_camera.cast<float>();
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex = world_from_camera * vertex;
  }
  return mesh;
}

SurfaceError CompareAt(const AnimatedSurface& surface, const Occasion& occasion,
                       const SurfaceErrorOptions& options) {
  return CompareSurfaces(ModelInWorld(surface, occasion), occasion.truth,
                         options);
}

/// Instance -> surface (see CompareInstances), best pairs first.
std::map<int, const AnimatedSurface*> MatchSurfaces(
    const std::vector<AnimatedSurface>& surfaces,
    const std::vector<Occasion>& occasions, SurfaceErrorOptions options) {
  options.samples = std::min(options.samples, kMatchingSamples);
  std::map<std::pair<int, std::size_t>, double> scores;
  std::map<int, int> counts;
  for (const Occasion& occasion : occasions) {
    ++counts[occasion.instance];
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (surfaces[i].background() ||
          !surfaces[i].Tracked(occasion.frame->index)) {
        continue;
      }
      scores[{occasion.instance, i}] +=
          CompareAt(surfaces[i], occasion, options).f_score.back();
    }
  }
  std::vector<std::tuple<double, int, std::size_t>> order;
  for (const auto& [pair, score] : scores) {
    if (score > 0) {
      order.emplace_back(-score / counts[pair.first], pair.first, pair.second);
    }
  }
  std::sort(order.begin(), order.end());
  std::map<int, const AnimatedSurface*> matches;
  std::set<std::size_t> used;
  for (const auto& [score, instance, i] : order) {
    if (matches.count(instance) > 0 || !used.insert(i).second) continue;
    matches[instance] = &surfaces[i];
  }
  return matches;
}

ViewError CompareView(const RecordedRun& run,
                      const std::vector<AnimatedSurface>& surfaces,
                      const std::string& label_folder, const Occasion& occasion,
                      double max_distance) {
  ViewError error;
  const std::filesystem::path path =
      std::filesystem::path(label_folder) / (occasion.frame->stem + ".png");
  if (!run.camera || label_folder.empty() || !std::filesystem::exists(path)) {
    return error;
  }
  const cv::Mat_<std::uint16_t> labels = ReadLabelImage(path.string());
  const PinholeCamera& camera = *run.camera;
  CheckSize(path.string(), labels.size(), camera);
  const cv::Mat_<float> depth =
      RenderModelDepth(surfaces, occasion.frame->index, camera);
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      if (labels(v, u) != occasion.instance) continue;
      ++error.pixels;
      if (!(depth(v, u) > 0)) continue;
      const Eigen::Vector3d point =
          camera.BackProject<double>(u, v, depth(v, u));
      points.push_back((occasion.world_from_camera * point).cast<float>());
    }
  }
  error.uncovered = error.pixels - static_cast<int>(points.size());
  error.distances = DescribeDistances(
      DistancesToSurface(points, occasion.truth.mesh, max_distance));
  return error;
}

InstanceFrameError CompareOccasion(const RecordedRun& run,
                                   const std::vector<AnimatedSurface>& surfaces,
                                   const AnimatedSurface* matched,
                                   const GroundTruth& truth,
                                   const Occasion& occasion,
                                   const SurfaceErrorOptions& options) {
  InstanceFrameError error;
  error.frame = occasion.frame->index;
  if (matched != nullptr && matched->Tracked(error.frame)) {
    error.matched = true;
    error.surface = CompareAt(*matched, occasion, options);
  }
  error.view =
      CompareView(run, surfaces, truth.labels, occasion, options.max_distance);
  return error;
}

}  // namespace

std::vector<InstanceError> CompareInstances(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const SurfaceErrorOptions& options) {
  const std::vector<Occasion> occasions = FindOccasions(run, truth);
  const auto matches = MatchSurfaces(surfaces, occasions, options);
  std::map<int, InstanceError> instances;
  for (const Occasion& occasion : occasions) {
    InstanceError& instance = instances[occasion.instance];
    instance.instance = occasion.instance;
    const auto match = matches.find(occasion.instance);
    const AnimatedSurface* matched =
        match != matches.end() ? match->second : nullptr;
    instance.frames.push_back(
        CompareOccasion(run, surfaces, matched, truth, occasion, options));
    if (matched != nullptr) {
      instance.surface_id = matched->recorded().id;
      instance.surface_label = matched->recorded().label;
    }
    const auto name = truth.names.find(occasion.instance);
    if (name != truth.names.end()) instance.name = name->second;
  }
  std::vector<InstanceError> result;
  for (auto& [id, instance] : instances) result.push_back(std::move(instance));
  return result;
}

}  // namespace splitfusion
