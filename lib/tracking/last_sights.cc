#include "splitfusion/lib/tracking/last_sights.h"

#include <utility>

namespace splitfusion {

void LastSights::Keep(int surface, const LiveView& live, const Rigid3d& pose) {
  std::optional<Sight> sight = SightOf(surface, live);
  if (sight) sights_[surface] = {std::move(*sight), pose.matrix()};
}

std::optional<Rigid3d> LastSights::FindMotion(int surface, const LiveView& live,
                                              const Rigid3d& predicted,
                                              double ratio) const {
  const auto last = sights_.find(surface);
  if (last == sights_.end()) return {};
  const std::optional<Sight> now = SightOf(surface, live);
  if (!now) return {};
  const auto& [sight, pose] = last->second;
  const std::optional<LandmarkMotion> found = FindLandmarkMotion(
      LandmarksOf(sight, live.camera), LandmarksOf(*now, live.camera),
      live.camera.noise, ratio);
  if (!found) return {};
  return found->motion * Rigid3d(pose) * predicted.inverse();
}

}  // namespace splitfusion
