#include "splitfusion/lib/association/canonical_places.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <memory>

#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

/// Nodes and mesh where they are in the camera frame.
class WarpedModel {
 public:
  WarpedModel(const DeformationGraph& graph,
              const std::vector<Eigen::Vector3f>& vertices,
              const std::vector<Eigen::Vector3f>& warped,
              const CoverageLimits& limits)
      : graph_(graph), vertices_(vertices), limits_(limits) {
    for (int i = 0; i < graph.size(); ++i) {
      centers_.push_back(
          (graph.positions[i] + graph.motions[i].translation).cast<float>());
    }
    nearest_node_ = std::make_unique<NearestPoint>(centers_);
    if (!warped.empty()) mesh_ = std::make_unique<NearestPoint>(warped);
  }

  /// What was found for the pixel before: the next one's is near.
  struct Hint {
    int vertex = -1;
    int node = -1;
  };

  Coverage Place(const Eigen::Vector3f& point, Hint* hint,
                 cv::Vec3f* place) const {
    float distance = 0;
    if (mesh_ != nullptr) {
      hint->vertex = mesh_->Find(point, hint->vertex, &distance);
      if (distance < limits_.mesh) {
        const Eigen::Vector3f& vertex = vertices_[hint->vertex];
        *place = {vertex.x(), vertex.y(), vertex.z()};
        return Coverage::kModelled;
      }
    }
    hint->node = nearest_node_->Find(point, hint->node, &distance);
    const Eigen::Vector3d carried =
        graph_.motions[hint->node].rotation.transpose() *
            (point - centers_[hint->node]).cast<double>() +
        graph_.positions[hint->node];
    *place = {static_cast<float>(carried.x()), static_cast<float>(carried.y()),
              static_cast<float>(carried.z())};
    if (distance < graph_.node_spacing) return Coverage::kNearNodes;
    return distance < limits_.reach ? Coverage::kBeyondNodes
                                    : Coverage::kOutOfReach;
  }

 private:
  const DeformationGraph& graph_;
  const std::vector<Eigen::Vector3f>& vertices_;
  const CoverageLimits limits_;
  std::vector<Eigen::Vector3f> centers_;
  std::unique_ptr<NearestPoint> nearest_node_;
  std::unique_ptr<NearestPoint> mesh_;
};

}  // namespace

CanonicalPlaces FindCanonicalPlaces(
    const LiveView& live, int surface, const DeformationGraph& graph,
    const std::vector<Eigen::Vector3f>& vertices,
    const std::vector<Eigen::Vector3f>& warped, const CoverageLimits& limits) {
  const WarpedModel model(graph, vertices, warped, limits);
  CanonicalPlaces found;
  found.points.create(live.depth.size());
  found.points.setTo(cv::Scalar::all(std::numeric_limits<float>::quiet_NaN()));
  found.coverage.create(live.depth.size());
  found.coverage.setTo(0);
  tbb::parallel_for(0, live.depth.rows, [&](int v) {
    WarpedModel::Hint hint;
    for (int u = 0; u < live.depth.cols; ++u) {
      if (live.labels(v, u) != surface || !(live.depth(v, u) > 0) ||
          live.edges(v, u) != 0 || live.uncertain(v, u) != 0) {
        continue;
      }
      const cv::Vec3f& p = live.map.points(v, u);
      found.coverage(v, u) = static_cast<std::uint8_t>(
          model.Place({p[0], p[1], p[2]}, &hint, &found.points(v, u)));
    }
  });
  return found;
}

}  // namespace splitfusion
