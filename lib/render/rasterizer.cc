#include "splitfusion/lib/render/rasterizer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {
namespace {

constexpr int kBandHeight = 16;  // Speed: rows rendered by one task.

/// A triangle in the image: corners in pixels, inverse depths.
struct ScreenTriangle {
  float u[3], v[3], inverse_z[3];
  float inverse_area;
  int id;
  int u_begin, u_end, v_begin, v_end;
};

float EdgeFunction(float au, float av, float bu, float bv, float pu, float pv) {
  return (bu - au) * (pv - av) - (bv - av) * (pu - au);
}

bool Project(const std::vector<Eigen::Vector3f>& vertices,
             const Eigen::Vector3i& triangle, const PinholeCamera& camera,
             bool cull_back_faces, ScreenTriangle* out) {
  const float fx = static_cast<float>(camera.fx);
  const float fy = static_cast<float>(camera.fy);
  const float cx = static_cast<float>(camera.cx);
  const float cy = static_cast<float>(camera.cy);
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f& p = vertices[triangle[k]];
    if (!(p.z() > kNearPlane)) return false;
    out->inverse_z[k] = 1.0f / p.z();
    out->u[k] = fx * p.x() * out->inverse_z[k] + cx;
    out->v[k] = fy * p.y() * out->inverse_z[k] + cy;
  }
  const float area = EdgeFunction(out->u[0], out->v[0], out->u[1], out->v[1],
                                  out->u[2], out->v[2]);
  // With y down, a triangle that is counter-clockwise seen from the camera has
  // a negative signed area here.
  if (area == 0 || !std::isfinite(area) || (cull_back_faces && area > 0)) {
    return false;
  }
  out->inverse_area = 1.0f / area;
  const auto [u_min, u_max] = std::minmax_element(out->u, out->u + 3);
  const auto [v_min, v_max] = std::minmax_element(out->v, out->v + 3);
  out->u_begin = static_cast<int>(std::ceil(std::max(*u_min, 0.0f)));
  out->v_begin = static_cast<int>(std::ceil(std::max(*v_min, 0.0f)));
  out->u_end = static_cast<int>(
      std::floor(std::min(*u_max, static_cast<float>(camera.width - 1))));
  out->v_end = static_cast<int>(
      std::floor(std::min(*v_max, static_cast<float>(camera.height - 1))));
  return out->u_begin <= out->u_end && out->v_begin <= out->v_end;
}

void DrawRows(const ScreenTriangle& t, int row_begin, int row_end,
              Raster* raster) {
  for (int v = std::max(t.v_begin, row_begin);
       v <= std::min(t.v_end, row_end - 1); ++v) {
    float* depths = raster->depth[v];
    const float pv = static_cast<float>(v);
    for (int u = t.u_begin; u <= t.u_end; ++u) {
      const float pu = static_cast<float>(u);
      const float b0 =
          t.inverse_area * EdgeFunction(t.u[1], t.v[1], t.u[2], t.v[2], pu, pv);
      const float b1 =
          t.inverse_area * EdgeFunction(t.u[2], t.v[2], t.u[0], t.v[0], pu, pv);
      const float b2 = 1.0f - b0 - b1;
      if (b0 < 0 || b1 < 0 || b2 < 0) continue;
      const float inverse_z =
          b0 * t.inverse_z[0] + b1 * t.inverse_z[1] + b2 * t.inverse_z[2];
      const float depth = 1.0f / inverse_z;
      if (depths[u] > 0 && depths[u] <= depth) continue;
      depths[u] = depth;
      raster->triangle(v, u) = t.id;
      raster->barycentric(v, u) =
          cv::Vec3f(b0 * t.inverse_z[0] * depth, b1 * t.inverse_z[1] * depth,
                    b2 * t.inverse_z[2] * depth);
    }
  }
}

}  // namespace

void Raster::Clear(const PinholeCamera& camera) {
  depth.create(camera.height, camera.width);
  triangle.create(camera.height, camera.width);
  barycentric.create(camera.height, camera.width);
  depth.setTo(0);
  triangle.setTo(-1);
}

void RasterizeTriangles(const std::vector<Eigen::Vector3f>& vertices,
                        const std::vector<Eigen::Vector3i>& triangles,
                        const PinholeCamera& camera, bool cull_back_faces,
                        int first_triangle_id, Raster* raster) {
  std::vector<ScreenTriangle> screen(triangles.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, triangles.size(), 4096),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const bool visible = Project(vertices, triangles[i], camera,
                                       cull_back_faces, &screen[i]);
          screen[i].id = visible ? first_triangle_id + static_cast<int>(i) : -1;
        }
      });
  const int bands = (camera.height + kBandHeight - 1) / kBandHeight;
  std::vector<std::vector<int>> band_triangles(bands);
  for (std::size_t i = 0; i < screen.size(); ++i) {
    if (screen[i].id < 0) continue;
    for (int band = screen[i].v_begin / kBandHeight;
         band <= screen[i].v_end / kBandHeight; ++band) {
      band_triangles[band].push_back(static_cast<int>(i));
    }
  }
  tbb::parallel_for(0, bands, [&](int band) {
    for (const int i : band_triangles[band]) {
      DrawRows(screen[i], band * kBandHeight,
               std::min(camera.height, (band + 1) * kBandHeight), raster);
    }
  });
}

}  // namespace splitfusion
