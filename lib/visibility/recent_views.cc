#include "splitfusion/lib/visibility/recent_views.h"

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// How far from the live depth a point may be and lie on it, metres: three
/// sigma of the noise, and what bends between two nodes.
constexpr DepthTolerance<double> kTolerance = {0.02};

/// The pixels nearest to a point that are looked at, every second one: near a
/// silhouette it may miss the surface by a few.
constexpr int kRadius = 4;
constexpr int kStep = 2;

}  // namespace

void RecentViews::Add(int frame, const LiveView& live) {
  views_.push_back({frame, live.camera, live.depth, live.labels});
  if (static_cast<int>(views_.size()) > frames_) views_.pop_front();
}

std::optional<Sighting> RecentViews::Look(int frame, int surface,
                                          const Eigen::Vector3d& point) const {
  const auto view =
      std::find_if(views_.begin(), views_.end(),
                   [frame](const View& v) { return v.frame == frame; });
  if (view == views_.end()) return std::nullopt;
  if (!(point.z() > 0)) return Sighting::kUnknown;
  const Eigen::Vector2d pixel = view->camera.Project(point);
  const bool in_image =
      pixel.x() > -0.5 && pixel.x() < view->camera.width - 0.5 &&
      pixel.y() > -0.5 && pixel.y() < view->camera.height - 0.5;
  return in_image ? LookAround(*view, surface, pixel, point.z())
                  : Sighting::kUnknown;
}

Sighting RecentViews::LookAround(const View& view, int surface,
                                 const Eigen::Vector2d& pixel, double z) {
  const int u = static_cast<int>(std::lround(pixel.x()));
  const int v = static_cast<int>(std::lround(pixel.y()));
  const int bottom = std::min(v + kRadius, view.camera.height - 1);
  const int right = std::min(u + kRadius, view.camera.width - 1);
  bool any_depth = false;
  bool all_behind = true;
  for (int y = std::max(v - kRadius, 0); y <= bottom; y += kStep) {
    for (int x = std::max(u - kRadius, 0); x <= right; x += kStep) {
      const double depth = view.depth(y, x);
      const DepthState state = ClassifyDepth(depth, z, kTolerance.At(depth));
      if (state == DepthState::kUnmeasured) continue;
      any_depth = true;
      if (state == DepthState::kFree) continue;
      all_behind = false;
      if (state == DepthState::kObserved && view.labels(y, x) == surface) {
        return Sighting::kSeen;
      }
    }
  }
  return any_depth && all_behind ? Sighting::kFreeSpace : Sighting::kUnknown;
}

}  // namespace splitfusion
