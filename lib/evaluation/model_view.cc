#include "splitfusion/lib/evaluation/model_view.h"

#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {

cv::Mat_<float> RenderModelDepth(const std::vector<AnimatedSurface>& surfaces,
                                 int frame, const PinholeCamera& camera) {
  Raster raster;
  raster.Clear(camera);
  for (const AnimatedSurface& surface : surfaces) {
    if (!surface.HasMotions(frame)) continue;
    RasterizeTriangles(
        surface.VerticesAt(frame), surface.recorded().mesh.triangles, camera,
        /*cull_back_faces=*/true, /*first_triangle_id=*/0, &raster);
  }
  return raster.depth;
}

}  // namespace splitfusion
