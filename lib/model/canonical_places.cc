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

/// Some vertices of a mesh, where they are in the camera frame.
class WarpedVertices {
 public:
  /// Those that may be near a live point and are confirmed, or are not.
  WarpedVertices(const PlacedMesh& mesh, bool confirmed, const LiveTiles& tiles,
                 float reach) {
    std::vector<Eigen::Vector3f> near;
    for (std::size_t i = 0; i < mesh.warped.size(); ++i) {
      if ((mesh.confirmed[i] != 0) != confirmed ||
          !tiles.MayBeNear(mesh.warped[i], reach)) {
        continue;
      }
      near.push_back(mesh.warped[i]);
      vertices_.push_back(static_cast<int>(i));
    }
    if (!near.empty()) nearest_ = std::make_unique<NearestPoint>(near);
  }

  /// The vertex that is nearest to a point, if it is nearer than `reach`,
  /// metres; else -1. `hint`: of the call for the pixel before.
  int Find(const Eigen::Vector3f& point, double reach, int* hint) const {
    if (nearest_ == nullptr) return -1;
    float distance = 0;
    *hint = nearest_->Find(point, *hint, &distance);
    return distance < reach ? vertices_[*hint] : -1;
  }

 private:
  std::vector<int> vertices_;
  std::unique_ptr<NearestPoint> nearest_;
};

/// Nodes and mesh where they are in the camera frame.
class WarpedModel {
 public:
  WarpedModel(const DeformationGraph& graph, const PlacedMesh& mesh,
              const LiveTiles& tiles, const CoverageLimits& limits)
      : graph_(graph),
        limits_(limits),
        vertices_(mesh.vertices),
        confirmed_(mesh, true, tiles, static_cast<float>(limits.mesh)),
        others_(mesh, false, tiles, static_cast<float>(limits.mesh)) {
    for (int i = 0; i < graph.size(); ++i) {
      centers_.push_back(
          (graph.positions[i] + graph.motions[i].translation).cast<float>());
    }
    nearest_node_ = std::make_unique<NearestPoint>(centers_);
  }

  /// What was found for the pixel before: the next one's is near.
  struct Hint {
    int confirmed = -1;
    int other = -1;
    int node = -1;
  };

  /// Where a live point belongs.
  struct Placed {
    Coverage coverage = Coverage::kNone;
    cv::Vec3f place;
    int vertex = -1;  // If the mesh is there.
  };

  Placed Place(const Eigen::Vector3f& point, Hint* hint) const {
    int vertex = confirmed_.Find(point, limits_.mesh, &hint->confirmed);
    if (vertex < 0) vertex = others_.Find(point, limits_.mesh, &hint->other);
    if (vertex >= 0) {
      const Eigen::Vector3f& p = vertices_[vertex];
      return {Coverage::kModelled, {p.x(), p.y(), p.z()}, vertex};
    }
    float distance = 0;
    hint->node = nearest_node_->Find(point, hint->node, &distance);
    const Eigen::Vector3d carried =
        graph_.motions[hint->node].rotation.transpose() *
            (point - centers_[hint->node]).cast<double>() +
        graph_.positions[hint->node];
    return {
        distance < limits_.reach ? Coverage::kCarried : Coverage::kOutOfReach,
        {static_cast<float>(carried.x()), static_cast<float>(carried.y()),
         static_cast<float>(carried.z())},
        -1};
  }

 private:
  const DeformationGraph& graph_;
  const CoverageLimits limits_;
  const std::vector<Eigen::Vector3f>& vertices_;
  const WarpedVertices confirmed_;
  const WarpedVertices others_;
  std::vector<Eigen::Vector3f> centers_;
  std::unique_ptr<NearestPoint> nearest_node_;
};

/// Pixels along the edge of a block of the image that has one place: what is
/// asked of places, centimetres, is far more than pixels are apart.
constexpr int kBlock = 2;

/// Places the certain points of a block where the first of them belongs.
/// Returns the vertex that is there, or -1.
int PlaceBlock(const LiveView& live, int surface, const WarpedModel& model,
               int v0, int u0, WarpedModel::Hint* hint,
               CanonicalPlaces* found) {
  WarpedModel::Placed placed;
  for (int v = v0; v < std::min(v0 + kBlock, live.depth.rows); ++v) {
    for (int u = u0; u < std::min(u0 + kBlock, live.depth.cols); ++u) {
      if (!IsCertain(live, surface, v, u)) continue;
      if (placed.coverage == Coverage::kNone) {
        const cv::Vec3f& p = live.map.points(v, u);
        placed = model.Place({p[0], p[1], p[2]}, hint);
      }
      found->points(v, u) = placed.place;
      found->coverage(v, u) = static_cast<std::uint8_t>(placed.coverage);
    }
  }
  return placed.vertex;
}

/// Vertices that occur, ascending, each once.
std::vector<int> Occurring(const std::vector<std::vector<int>>& lists) {
  std::vector<int> all;
  for (const std::vector<int>& list : lists) {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

CanonicalPlaces FindCanonicalPlaces(const LiveView& live, int surface,
                                    const DeformationGraph& graph,
                                    const PlacedMesh& mesh,
                                    const CoverageLimits& limits) {
  const WarpedModel model(graph, mesh, LiveTiles(live, surface), limits);
  CanonicalPlaces found;
  found.points.create(live.depth.size());
  found.points.setTo(cv::Scalar::all(std::numeric_limits<float>::quiet_NaN()));
  found.coverage.create(live.depth.size());
  found.coverage.setTo(0);
  const int rows = (live.depth.rows + kBlock - 1) / kBlock;
  std::vector<std::vector<int>> shown(rows);
  tbb::parallel_for(0, rows, [&](int row) {
    WarpedModel::Hint hint;
    for (int u = 0; u < live.depth.cols; u += kBlock) {
      const int vertex =
          PlaceBlock(live, surface, model, row * kBlock, u, &hint, &found);
      if (vertex >= 0) shown[row].push_back(vertex);
    }
  });
  found.shown = Occurring(shown);
  return found;
}

}  // namespace splitfusion
