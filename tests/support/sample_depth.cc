#include "support/sample_depth.h"

#include <cmath>

#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {
namespace {

/// Image of depth(ray), where `ray` is the point of the pixel at z = 1.
cv::Mat_<float> DepthByRay(
    const PinholeCamera& camera,
    const std::function<double(const Eigen::Vector3d& ray)>& depth) {
  cv::Mat_<float> image(camera.height, camera.width);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      image(v, u) =
          static_cast<float>(depth(camera.BackProject<double>(u, v, 1)));
    }
  }
  return image;
}

}  // namespace

PinholeCamera SmallCamera() {
  PinholeCamera camera;
  camera.width = 160, camera.height = 120;
  camera.fx = 130, camera.fy = 131;
  camera.cx = 79.3, camera.cy = 59.8;
  return camera;
}

cv::Mat_<float> PlaneDepth(const PinholeCamera& camera,
                           const Eigen::Vector3d& normal, double d) {
  return DepthByRay(camera, [&](const Eigen::Vector3d& ray) {
    const double z = d / normal.dot(ray);
    return z > 0 ? z : 0;
  });
}

cv::Mat_<float> WallDepth(const PinholeCamera& camera, double z) {
  return PlaneDepth(camera, {0, 0, 1}, z);
}

cv::Mat_<float> SphereDepth(const PinholeCamera& camera,
                            const Eigen::Vector3d& center, double radius) {
  return DepthByRay(camera, [&](const Eigen::Vector3d& ray) {
    // |z ray - center|^2 = radius^2, the nearer solution.
    const double a = ray.squaredNorm(), b = ray.dot(center);
    const double c = center.squaredNorm() - radius * radius;
    const double root = b * b - a * c;
    return root > 0 ? (b - std::sqrt(root)) / a : 0;
  });
}

cv::Mat_<float> MeshDepth(const PinholeCamera& camera,
                          const TriangleMesh& mesh) {
  Raster raster;
  raster.Clear(camera);
  RasterizeTriangles(mesh.vertices, mesh.triangles, camera,
                     /*cull_back_faces=*/false, /*first_triangle_id=*/0,
                     &raster);
  return raster.depth;
}

cv::Mat PlainColor(const PinholeCamera& camera, const cv::Vec3b& bgr) {
  return cv::Mat(camera.height, camera.width, CV_8UC3,
                 cv::Scalar(bgr[0], bgr[1], bgr[2]));
}

DepthObservation ObserveAll(const PinholeCamera& camera,
                            const cv::Mat_<float>& depth) {
  DepthObservation observation;
  observation.camera = camera;
  observation.depth = depth;
  observation.weight = cv::Mat_<float>(depth.size(), 1.f);
  observation.role = cv::Mat_<std::uint8_t>(
      depth.size(), static_cast<std::uint8_t>(PixelRole::kWrite));
  observation.color = PlainColor(camera, {0, 0, 255});
  return observation;
}

}  // namespace splitfusion
