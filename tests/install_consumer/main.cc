// Renders one square with the installed library and checks its depth.

#include <cstdio>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/render/rasterizer.h"

namespace {

/// A square of 2 m at z = 2 m, facing the camera.
splitfusion::TriangleMesh Square() {
  splitfusion::TriangleMesh mesh;
  mesh.vertices = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}};
  return mesh;
}

}  // namespace

int main() {
  splitfusion::PinholeCamera camera;
  camera.width = 32;
  camera.height = 24;
  camera.fx = camera.fy = 30;
  camera.cx = 15.5;
  camera.cy = 11.5;

  const splitfusion::TriangleMesh mesh = Square();
  splitfusion::Raster raster;
  raster.Clear(camera);
  splitfusion::RasterizeTriangles(mesh.vertices, mesh.triangles, camera,
                                  /*cull_back_faces=*/true,
                                  /*first_triangle_id=*/0, &raster);
  const float depth = raster.depth(12, 16);
  std::printf("depth of the square: %.3f m\n", depth);
  return depth > 1.999f && depth < 2.001f ? 0 : 1;
}
