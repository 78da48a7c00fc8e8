#include "splitfusion/lib/tracking/image_shift.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr int kColumns = 80;     // Of the grid that is searched.
constexpr int kMaxColumns = 40;  // Steps to either side.
constexpr int kMaxRows = 12;     // Steps up and down.
constexpr int kMaxLayers = 5;    // Steps nearer and farther.
constexpr float kLayer = 0.08f;  // Metres a step.
constexpr double kMinExplained = 0.3;
/// Between model and live.
constexpr DepthTolerance<float> kTolerance = {0.1f};

/// A depth of a coarse grid.
struct GridPoint {
  int u = 0, v = 0;
  float depth = 0;
};

/// A candidate and what it is worth.
struct Shift {
  int du = 0, dv = 0, layer = 0;
  int hits = 0;
  double score = -1e9;
};

/// Every step-th pixel of `depth`, 0 where `keep` is false.
template <typename Keep>
cv::Mat_<float> Coarse(const cv::Mat_<float>& depth, int step,
                       const Keep& keep) {
  cv::Mat_<float> coarse((depth.rows + step - 1) / step,
                         (depth.cols + step - 1) / step);
  for (int v = 0; v < coarse.rows; ++v) {
    for (int u = 0; u < coarse.cols; ++u) {
      const bool kept = keep(v * step, u * step);
      coarse(v, u) = kept ? depth(v * step, u * step) : 0.0f;
    }
  }
  return coarse;
}

std::vector<GridPoint> Points(const cv::Mat_<float>& grid) {
  std::vector<GridPoint> points;
  for (int v = 0; v < grid.rows; ++v) {
    for (int u = 0; u < grid.cols; ++u) {
      if (grid(v, u) > 0) points.push_back({u, v, grid(v, u)});
    }
  }
  return points;
}

float At(const cv::Mat_<float>& grid, int v, int u) {
  const bool inside = u >= 0 && v >= 0 && u < grid.cols && v < grid.rows;
  return inside ? grid(v, u) : 0.0f;
}

DepthState Compare(float live, float model) {
  return ClassifyDepth(live, model, kTolerance.At(live));
}

/// What is searched through: the coarse grids.
struct Search {
  cv::Mat_<float> model;
  cv::Mat_<float> live;            // Everything that is seen.
  std::vector<GridPoint> own;      // Live points of the surface.
  std::vector<GridPoint> visible;  // Model points.

  /// Explained live points count for a shift; model points that would hide
  /// what is seen behind them, and the way itself, count against it.
  Shift Score(int du, int dv, int layer) const {
    Shift shift{du, dv, layer};
    for (const GridPoint& p : own) {
      const float z = At(model, p.v - dv, p.u - du);
      shift.hits += z > 0 && Compare(p.depth, z + kLayer * layer) ==
                                 DepthState::kObserved;
    }
    int violations = 0;
    for (const GridPoint& p : visible) {
      const float z = At(live, p.v + dv, p.u + du);
      violations += Compare(z, p.depth + kLayer * layer) == DepthState::kFree;
    }
    const double way = std::abs(du) + std::abs(dv) + std::abs(layer);
    shift.score = shift.hits - 0.5 * violations - 0.002 * way * own.size();
    return shift;
  }

  Shift BestOfColumn(int du) const {
    Shift best;
    for (int dv = -kMaxRows; dv <= kMaxRows; ++dv) {
      for (int layer = -kMaxLayers; layer <= kMaxLayers; ++layer) {
        const Shift shift = Score(du, dv, layer);
        if (shift.score > best.score) best = shift;
      }
    }
    return best;
  }
};

float MedianDepth(std::vector<GridPoint> points) {
  const auto middle = points.begin() + points.size() / 2;
  std::nth_element(
      points.begin(), middle, points.end(),
      [](const GridPoint& a, const GridPoint& b) { return a.depth < b.depth; });
  return middle->depth;
}

}  // namespace

std::optional<Rigid3d> FindImageShift(const cv::Mat_<float>& model,
                                      const LiveView& live,
                                      std::uint16_t surface) {
  const int stride = std::max(1, live.depth.cols / std::max(1, model.cols));
  Search search;
  const int model_step = std::max(1, live.depth.cols / kColumns / stride);
  const int step = model_step * stride;  // Live pixels between candidates.
  search.model = Coarse(model, model_step, [](int, int) { return true; });
  search.live = Coarse(live.depth, step, [](int, int) { return true; });
  search.own = Points(Coarse(live.depth, step, [&](int v, int u) {
    return live.labels(v, u) == surface;
  }));
  search.visible = Points(search.model);
  if (search.own.empty() || search.visible.empty()) return std::nullopt;
  std::vector<Shift> columns(2 * kMaxColumns + 1);
  tbb::parallel_for(0, 2 * kMaxColumns + 1, [&](int i) {
    columns[i] = search.BestOfColumn(i - kMaxColumns);
  });
  const Shift best = *std::max_element(
      columns.begin(), columns.end(),
      [](const Shift& a, const Shift& b) { return a.score < b.score; });
  const auto comparable = std::min(search.own.size(), search.visible.size());
  if (best.hits < kMinExplained * comparable) return std::nullopt;
  const double z = MedianDepth(search.own);
  Rigid3d motion = Rigid3d::Identity();
  motion.translation() =
      Eigen::Vector3d(best.du * step * z / live.camera.fx,
                      best.dv * step * z / live.camera.fy, kLayer * best.layer);
  return motion;
}

}  // namespace splitfusion
