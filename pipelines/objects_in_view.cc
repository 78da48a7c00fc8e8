#include "splitfusion/pipelines/objects_in_view.h"

#include <map>
#include <utility>

#include "splitfusion/lib/visibility/exposure.h"

namespace splitfusion {

std::vector<SurfaceReport> LookAtObjects(const SurfaceMap& surfaces,
                                         const MeshRendering& rendering,
                                         const LiveView& live, int stride) {
  const std::map<int, int> pixels = PixelsOfSurfaces(live);
  std::vector<SurfaceReport> objects;
  for (const auto& [id, surface] : surfaces) {
    if (id == 0) continue;
    SurfaceReport object;
    object.id = id;
    const auto seen = pixels.find(id);
    object.pixels = seen == pixels.end() ? 0 : seen->second;
    const auto alone = rendering.alone.find(id);
    if (alone != rendering.alone.end()) {
      object.exposure =
          Exposure(alone->second, kAloneStride * stride, live, id);
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

bool IsEnoughInView(const SurfaceReport& report,
                    const PipelineOptions& options) {
  return report.pixels >= options.min_tracked_pixels &&
         report.exposure >= options.min_exposure;
}

}  // namespace splitfusion
