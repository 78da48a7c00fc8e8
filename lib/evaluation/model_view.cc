#include "splitfusion/lib/evaluation/model_view.h"

#include <algorithm>

#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {
namespace {

/// Surface ids of triangle indices; `ends[i]` is one past the last index of
/// surface i.
cv::Mat_<int> ToSurfaceIds(
    const cv::Mat_<int>& triangles, const std::vector<int>& ends,
    const std::vector<const AnimatedSurface*>& surfaces) {
  cv::Mat_<int> ids(triangles.size(), -1);
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      if (triangles(v, u) < 0) continue;
      const auto end =
          std::upper_bound(ends.begin(), ends.end(), triangles(v, u));
      ids(v, u) = surfaces[end - ends.begin()]->recorded().id;
    }
  }
  return ids;
}

}  // namespace

ModelView RenderModelView(const std::vector<const AnimatedSurface*>& surfaces,
                          int frame, const PinholeCamera& camera) {
  Raster raster;
  raster.Clear(camera);
  std::vector<int> ends;
  for (const AnimatedSurface* surface : surfaces) {
    const TriangleMesh mesh = surface->MeshAt(frame);
    const int first = ends.empty() ? 0 : ends.back();
    RasterizeTriangles(mesh.vertices, mesh.triangles, camera,
                       /*cull_back_faces=*/true, first, &raster);
    ends.push_back(first + static_cast<int>(mesh.triangles.size()));
  }
  return {raster.depth, ToSurfaceIds(raster.triangle, ends, surfaces)};
}

cv::Mat_<float> RenderModelDepth(const std::vector<AnimatedSurface>& surfaces,
                                 int frame, const PinholeCamera& camera) {
  std::vector<const AnimatedSurface*> shown;
  for (const AnimatedSurface& surface : surfaces) {
    if (surface.HasMotions(frame)) shown.push_back(&surface);
  }
  return RenderModelView(shown, frame, camera).depth;
}

}  // namespace splitfusion
