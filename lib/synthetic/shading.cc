#include "splitfusion/lib/synthetic/shading.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

const cv::Vec3f kBackdrop(0.4f, 0.4f, 0.4f);

/// The lights of the room in the camera frame.
struct Lights {
  Vector3f up;
  Vector3f lamps[2];
};

Lights LightsInCamera(const Rigid3d& world_from_camera) {
  const Rigid3f camera_from_world = world_from_camera.inverse().cast<float>();
  return {camera_from_world.linear() * Vector3f::UnitZ(),
          {camera_from_world * Vector3f(-1.0f, -0.9f, 2.45f),
           camera_from_world * Vector3f(1.1f, 0.2f, 2.45f)}};
}

float Brightness(const Lights& lights, const Vector3f& point,
                 const Vector3f& normal) {
  float light = 0.5f + 0.15f * normal.dot(lights.up);
  for (const Vector3f& lamp : lights.lamps) {
    const Vector3f to_lamp = lamp - point;
    const float distance2 = to_lamp.squaredNorm();
    light += 0.9f * std::max(0.0f, normal.dot(to_lamp)) /
             (std::sqrt(distance2) * (1.0f + 0.5f * distance2));
  }
  return light;
}

Vector3f Interpolate(const std::vector<Vector3f>& values,
                     const Eigen::Vector3i& triangle, const cv::Vec3f& weight) {
  return weight[0] * values[triangle[0]] + weight[1] * values[triangle[1]] +
         weight[2] * values[triangle[2]];
}

cv::Vec3f ShadePixel(const PosedSurface& surface, int triangle_index,
                     const cv::Vec3f& weight, const Lights& lights) {
  const TexturedMesh& rest = *surface.rest;
  const Eigen::Vector3i& triangle = rest.mesh.triangles[triangle_index];
  const Vector3f rest_point = Interpolate(rest.mesh.vertices, triangle, weight);
  const std::uint16_t material = rest.material_at
                                     ? rest.material_at(rest_point)
                                     : rest.triangle_materials[triangle_index];
  const Vector3f albedo = MaterialColor(rest.materials[material], rest_point);
  const Vector3f point = Interpolate(surface.vertices, triangle, weight);
  const Vector3f normal =
      Interpolate(surface.normals, triangle, weight).normalized();
  const Vector3f rgb = albedo * Brightness(lights, point, normal);
  return {rgb.z(), rgb.y(), rgb.x()};
}

/// Renders all surfaces; `first_ids` receives the id of each one's first
/// triangle.
Raster Rasterize(const std::vector<PosedSurface>& surfaces,
                 const PinholeCamera& camera, std::vector<int>* first_ids) {
  Raster raster;
  raster.Clear(camera);
  int first = 0;
  for (const PosedSurface& surface : surfaces) {
    first_ids->push_back(first);
    RasterizeTriangles(surface.vertices, surface.rest->mesh.triangles, camera,
                       /*cull_back_faces=*/true, first, &raster);
    first += static_cast<int>(surface.rest->mesh.triangles.size());
  }
  return raster;
}

}  // namespace

RenderedScene RenderSurfaces(const std::vector<PosedSurface>& surfaces,
                             const PinholeCamera& camera,
                             const Rigid3d& world_from_camera) {
  std::vector<int> first_ids;
  const Raster raster = Rasterize(surfaces, camera, &first_ids);
  const Lights lights = LightsInCamera(world_from_camera);
  RenderedScene scene;
  scene.depth = raster.depth;
  scene.color.create(camera.height, camera.width);
  scene.label.create(camera.height, camera.width);
  tbb::parallel_for(0, camera.height, [&](int v) {
    for (int u = 0; u < camera.width; ++u) {
      const int id = raster.triangle(v, u);
      scene.color(v, u) = kBackdrop;
      scene.label(v, u) = 0;
      if (id < 0) continue;
      const auto next =
          std::upper_bound(first_ids.begin(), first_ids.end(), id);
      const std::size_t index = next - first_ids.begin() - 1;
      const PosedSurface& surface = surfaces[index];
      const int triangle = id - first_ids[index];
      scene.color(v, u) =
          ShadePixel(surface, triangle, raster.barycentric(v, u), lights);
      scene.label(v, u) = surface.rest->triangle_instances[triangle];
    }
  });
  return scene;
}

}  // namespace splitfusion
