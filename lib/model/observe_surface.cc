#include "splitfusion/lib/model/observe_surface.h"

namespace splitfusion {

DepthObservation ObserveSurface(const LiveView& live, int surface) {
  DepthObservation observation;
  observation.camera = live.camera;
  observation.depth = live.depth;
  observation.weight = live.confidence;
  observation.color = live.color;
  observation.role.create(live.depth.size());
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols; ++u) {
      PixelRole role = PixelRole::kNone;
      if (live.uncertain(v, u) == 0 && live.edges(v, u) == 0) {
        role = live.labels(v, u) == surface ? PixelRole::kWrite
                                            : PixelRole::kCarve;
      }
      observation.role(v, u) = static_cast<std::uint8_t>(role);
    }
  }
  return observation;
}

}  // namespace splitfusion
