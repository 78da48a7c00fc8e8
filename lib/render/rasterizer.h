#ifndef SPLITFUSION_LIB_RENDER_RASTERIZER_H_
#define SPLITFUSION_LIB_RENDER_RASTERIZER_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// What the nearest triangle of each pixel is; attributes are interpolated from
/// it by the caller. Reused between calls without allocation.
struct Raster {
  cv::Mat_<float> depth;            ///< HxW z-depth, metres; 0 = nothing.
  cv::Mat_<int> triangle;           ///< HxW triangle index; -1 = nothing.
  cv::Mat_<cv::Vec3f> barycentric;  ///< HxW weights of its three corners.

  /// Empties the raster for an image of the camera's size.
  void Clear(const PinholeCamera& camera);
};

/// Renders triangles with a z-buffer and perspective-correct weights.
///
/// `vertices`: camera frame, metres. Triangles with a corner nearer than 1 cm
/// are left out (no near-plane clipping); with `cull_back_faces` so are those
/// seen from behind. Pixels nearer than the new triangle are kept, so several
/// meshes may be rendered one after another; their triangle indices are told
/// apart by `first_triangle_id`, which is added to the index. The image is cut
/// into bands rendered in parallel; the result does not depend on threads.
void RasterizeTriangles(const std::vector<Eigen::Vector3f>& vertices,
                        const std::vector<Eigen::Vector3i>& triangles,
                        const PinholeCamera& camera, bool cull_back_faces,
                        int first_triangle_id, Raster* raster);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_RASTERIZER_H_
