#include "splitfusion/lib/evaluation/instance_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/live_images.h"
#include "splitfusion/lib/evaluation/model_view.h"

namespace splitfusion {
namespace {

/// Samples that suffice to tell which surface is which instance.
constexpr int kMatchingSamples = 2000;

SurfaceError CompareAt(const AnimatedSurface& surface,
                       const TrueOccasion& occasion,
                       const SurfaceErrorOptions& options) {
  return CompareSurfaces(ModelInWorld(surface, occasion), occasion.truth,
                         options);
}

/// Instance -> surface (see CompareInstances), best pairs first.
std::map<int, const AnimatedSurface*> MatchSurfaces(
    const std::vector<AnimatedSurface>& surfaces,
    const std::vector<TrueOccasion>& occasions, SurfaceErrorOptions options) {
  options.samples = std::min(options.samples, kMatchingSamples);
  std::map<std::pair<int, std::size_t>, double> scores;
  std::map<int, int> counts;
  for (const TrueOccasion& occasion : occasions) {
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
                      const std::string& label_folder,
                      const TrueOccasion& occasion, double max_distance) {
  ViewError error;
  if (!run.camera) return error;
  const PinholeCamera& camera = *run.camera;
  const cv::Mat_<std::uint16_t> labels =
      ReadIds(label_folder, *occasion.frame, camera);
  if (labels.empty()) return error;
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

ErrorStatistics AllAt(double distance, int count) {
  return {count, distance, distance, distance, distance, distance};
}

/// That of a surface of which nothing is right.
SurfaceError WorstSurfaceError(const SurfaceErrorOptions& options) {
  SurfaceError error;
  error.accuracy.statistics = AllAt(options.max_distance, options.samples);
  error.completeness = error.accuracy;
  return error;
}

/// The view of an instance at whose pixels nothing is right.
ViewError Worst(ViewError view, double max_distance) {
  view.uncovered = view.pixels;
  view.distances = {AllAt(max_distance, view.pixels), {}};
  return view;
}

/// Whether an instance that is in plain view is not shown by its surface.
bool IsMissing(const InstancePresence* presence, const AnimatedSurface* matched,
               int frame) {
  if (presence == nullptr || !presence->InView(frame)) return false;
  return presence->Missing(frame) || matched == nullptr ||
         !matched->HasMotions(frame);
}

InstanceFrameError CompareOccasion(const RecordedRun& run,
                                   const std::vector<AnimatedSurface>& surfaces,
                                   const AnimatedSurface* matched,
                                   const InstancePresence* presence,
                                   const GroundTruth& truth,
                                   const TrueOccasion& occasion,
                                   const SurfaceErrorOptions& options) {
  InstanceFrameError error;
  error.frame = occasion.frame->index;
  error.missing = IsMissing(presence, matched, error.frame);
  error.view =
      CompareView(run, surfaces, truth.labels, occasion, options.max_distance);
  if (error.missing) {
    error.matched = true;
    error.surface = WorstSurfaceError(options);
    error.view = Worst(error.view, options.max_distance);
  } else if (matched != nullptr &&
             (matched->Tracked(error.frame) ||
              (presence != nullptr && presence->InView(error.frame)))) {
    error.matched = true;
    error.surface = CompareAt(*matched, occasion, options);
  }
  return error;
}

/// An instance without frames.
InstanceError Describe(int id, const GroundTruth& truth,
                       const AnimatedSurface* matched,
                       const InstancePresence* presence) {
  InstanceError instance;
  instance.instance = id;
  const TrueInstance described = truth.Find(id);
  instance.name = described.name;
  instance.rigid = described.rigid;
  if (matched != nullptr) {
    instance.surface_id = matched->recorded().id;
    instance.surface_label = matched->recorded().label;
  }
  if (presence != nullptr) instance.presence = *presence;
  return instance;
}

}  // namespace

std::vector<InstanceError> CompareInstances(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, const std::vector<TrueOccasion>& occasions,
    const std::map<int, InstancePresence>& presences,
    const SurfaceErrorOptions& options) {
  std::set<int> ids;
  for (const TrueOccasion& occasion : occasions) ids.insert(occasion.instance);
  for (const auto& [id, presence] : presences) ids.insert(id);
  const auto matches = MatchSurfaces(surfaces, occasions, options);
  std::vector<InstanceError> result;
  for (const int id : ids) {
    const auto match = matches.find(id);
    const AnimatedSurface* matched =
        match != matches.end() ? match->second : nullptr;
    const auto found = presences.find(id);
    const InstancePresence* presence =
        found != presences.end() ? &found->second : nullptr;
    result.push_back(Describe(id, truth, matched, presence));
    for (const TrueOccasion& occasion : occasions) {
      if (occasion.instance != id) continue;
      result.back().frames.push_back(CompareOccasion(
          run, surfaces, matched, presence, truth, occasion, options));
    }
  }
  return result;
}

}  // namespace splitfusion
