#include "splitfusion/lib/model/canonical_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

/// Where the live points of a surface are, roughly: the range of their depth in
/// every tile of the image. Tells most of a mesh, all that is turned away or
/// hidden, from what may be at one of them.
class LiveTiles {
 public:
  LiveTiles(const LiveView& live, int surface) : camera_(live.camera) {
    const int columns = (live.depth.cols + kTile - 1) / kTile;
    const int rows = (live.depth.rows + kTile - 1) / kTile;
    ranges_.create(rows, columns);
    tbb::parallel_for(0, rows, [&](int row) {
      for (int column = 0; column < columns; ++column) {
        ranges_(row, column) = RangeOf(live, surface, row, column);
      }
    });
  }

  /// False if no live point is within `reach` (metres) of `p`.
  bool MayBeNear(const Eigen::Vector3f& p, float reach) const {
    // So near that it may be anywhere in the image.
    if (!(p.z() > 2 * reach)) return p.z() > -reach;
    const Eigen::Vector2f pixel = camera_.Project(p);
    // How far apart the two may be in the image: |x / z| and |y / z| are < 3.
    const float radius = 4 *
                         static_cast<float>(std::max(camera_.fx, camera_.fy)) *
                         reach / (p.z() - reach);
    const cv::Rect near = TilesAround(pixel, radius);
    for (int row = near.y; row < near.y + near.height; ++row) {
      for (int column = near.x; column < near.x + near.width; ++column) {
        const cv::Vec2f& range = ranges_(row, column);
        if (p.z() > range[0] - reach && p.z() < range[1] + reach) return true;
      }
    }
    return false;
  }

 private:
  static constexpr int kTile = 16;  // Speed: pixels.

  static cv::Vec2f RangeOf(const LiveView& live, int surface, int row,
                           int column) {
    cv::Vec2f range(std::numeric_limits<float>::max(), 0);
    const int v_end = std::min(live.depth.rows, (row + 1) * kTile);
    const int u_end = std::min(live.depth.cols, (column + 1) * kTile);
    for (int v = row * kTile; v < v_end; ++v) {
      for (int u = column * kTile; u < u_end; ++u) {
        if (!IsCertain(live, surface, v, u)) continue;
        range[0] = std::min(range[0], live.depth(v, u));
        range[1] = std::max(range[1], live.depth(v, u));
      }
    }
    return range;
  }

  cv::Rect TilesAround(const Eigen::Vector2f& pixel, float radius) const {
    const auto tile = [](float x, int count) {
      return static_cast<int>(
          std::clamp(std::floor(x / kTile), -1.0f, static_cast<float>(count)));
    };
    const int left = tile(pixel.x() - radius, ranges_.cols);
    const int right = tile(pixel.x() + radius, ranges_.cols);
    const int top = tile(pixel.y() - radius, ranges_.rows);
    const int bottom = tile(pixel.y() + radius, ranges_.rows);
    return cv::Rect(left, top, right - left + 1, bottom - top + 1) &
           cv::Rect(0, 0, ranges_.cols, ranges_.rows);
  }

  const PinholeCamera camera_;
  cv::Mat_<cv::Vec2f> ranges_;  // Nearest and farthest, metres.
};

/// Nodes and mesh where they are in the camera frame.
class WarpedModel {
 public:
  WarpedModel(const DeformationGraph& graph,
              const std::vector<Eigen::Vector3f>& vertices,
              const std::vector<Eigen::Vector3f>& warped,
              const LiveTiles& tiles, const CoverageLimits& limits)
      : graph_(graph), limits_(limits) {
    for (int i = 0; i < graph.size(); ++i) {
      centers_.push_back(
          (graph.positions[i] + graph.motions[i].translation).cast<float>());
    }
    nearest_node_ = std::make_unique<NearestPoint>(centers_);
    std::vector<Eigen::Vector3f> near;
    for (std::size_t i = 0; i < warped.size(); ++i) {
      if (!tiles.MayBeNear(warped[i], static_cast<float>(limits.mesh))) {
        continue;
      }
      near.push_back(warped[i]);
      vertices_.push_back(vertices[i]);
    }
    if (!near.empty()) mesh_ = std::make_unique<NearestPoint>(near);
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
    return distance < limits_.reach ? Coverage::kCarried
                                    : Coverage::kOutOfReach;
  }

 private:
  const DeformationGraph& graph_;
  const CoverageLimits limits_;
  std::vector<Eigen::Vector3f> vertices_;  // Those that may be near.
  std::vector<Eigen::Vector3f> centers_;
  std::unique_ptr<NearestPoint> nearest_node_;
  std::unique_ptr<NearestPoint> mesh_;
};

/// Pixels along the edge of a block of the image that has one place: what is
/// asked of places, centimetres, is far more than pixels are apart.
constexpr int kBlock = 2;

/// Places the certain points of a block where the first of them belongs.
void PlaceBlock(const LiveView& live, int surface, const WarpedModel& model,
                int v0, int u0, WarpedModel::Hint* hint,
                CanonicalPlaces* found) {
  Coverage coverage = Coverage::kNone;
  cv::Vec3f place;
  for (int v = v0; v < std::min(v0 + kBlock, live.depth.rows); ++v) {
    for (int u = u0; u < std::min(u0 + kBlock, live.depth.cols); ++u) {
      if (!IsCertain(live, surface, v, u)) continue;
      if (coverage == Coverage::kNone) {
        const cv::Vec3f& p = live.map.points(v, u);
        coverage = model.Place({p[0], p[1], p[2]}, hint, &place);
      }
      found->points(v, u) = place;
      found->coverage(v, u) = static_cast<std::uint8_t>(coverage);
    }
  }
}

}  // namespace

CanonicalPlaces FindCanonicalPlaces(
    const LiveView& live, int surface, const DeformationGraph& graph,
    const std::vector<Eigen::Vector3f>& vertices,
    const std::vector<Eigen::Vector3f>& warped, const CoverageLimits& limits) {
  const WarpedModel model(graph, vertices, warped, LiveTiles(live, surface),
                          limits);
  CanonicalPlaces found;
  found.points.create(live.depth.size());
  found.points.setTo(cv::Scalar::all(std::numeric_limits<float>::quiet_NaN()));
  found.coverage.create(live.depth.size());
  found.coverage.setTo(0);
  tbb::parallel_for(0, (live.depth.rows + kBlock - 1) / kBlock, [&](int row) {
    WarpedModel::Hint hint;
    for (int u = 0; u < live.depth.cols; u += kBlock) {
      PlaceBlock(live, surface, model, row * kBlock, u, &hint, &found);
    }
  });
  return found;
}

}  // namespace splitfusion
