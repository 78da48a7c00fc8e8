#include "splitfusion/lib/evaluation/posed_model.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/geometry/depth_noise.h"
#include "splitfusion/lib/geometry/triangle_corners.h"

namespace splitfusion {
namespace {

/// Nearer points are not looked at, metres.
constexpr float kNearest = 0.2f;
/// At the border of the image, pixels.
constexpr int kMargin = 2;
/// Larger triangles are sampled so densely, pixels.
constexpr float kSampling = 2;
/// Samples along an edge, at most.
constexpr int kMaxSteps = 200;

/// Live depth at the pixel of a point; 0 without depth or outside of the image
/// but for `margin` pixels.
float LiveDepthAt(const Eigen::Vector3f& point, const PinholeCamera& camera,
                  const cv::Mat_<float>& live, int margin, cv::Point* pixel) {
  const auto at = camera.PixelOf(point);
  if (!at) return 0;
  *pixel = {at->x(), at->y()};
  const cv::Rect inner(margin, margin, live.cols - 2 * margin,
                       live.rows - 2 * margin);
  return pixel->inside(inner) ? live(*pixel) : 0;
}

/// Marks the pixels at which points lie at the live depth.
class Marker {
 public:
  Marker(const PinholeCamera& camera, const cv::Mat_<float>& live)
      : camera_(camera), live_(live), marked_(live.size(), 0) {}

  void Add(const Eigen::Vector3f& point) {
    if (!(point.z() > kNearest)) return;
    cv::Point pixel;
    const float live = LiveDepthAt(point, camera_, live_, kMargin, &pixel);
    if (live > 0 && std::abs(live - point.z()) < kShownTolerance) {
      marked_(pixel) = 255;
    }
  }

  /// Adds points inside of a triangle, if its corners are far apart.
  void AddInside(const TriangleCorners& corners) {
    if (!(corners.Nearest() > kNearest)) return;
    const float pixels = static_cast<float>(camera_.fx) *
                         corners.LongestEdge() / corners.Nearest();
    const int steps =
        std::min(static_cast<int>(std::ceil(pixels / kSampling)), kMaxSteps);
    if (steps < 2) return;
    const Eigen::Vector3f ab = (corners.b - corners.a) / steps;
    const Eigen::Vector3f ac = (corners.c - corners.a) / steps;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        Add(corners.a + i * ab + j * ac);
      }
    }
  }

  cv::Mat_<std::uint8_t> Grown() const {
    cv::Mat_<std::uint8_t> grown;
    cv::dilate(marked_, grown, cv::Mat::ones(5, 5, CV_8U));
    return grown;
  }

 private:
  const PinholeCamera& camera_;
  const cv::Mat_<float>& live_;
  cv::Mat_<std::uint8_t> marked_;
};

}  // namespace

StrayArea MeasureStray(const TriangleMesh& mesh, const PinholeCamera& camera,
                       const cv::Mat_<float>& live) {
  StrayArea result;
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    const TriangleCorners corners(mesh, triangle);
    const Eigen::Vector3f centre = (corners.a + corners.b + corners.c) / 3;
    if (!(centre.z() > kNearest) || corners.Cross().dot(centre) >= 0) continue;
    cv::Point pixel;
    const float depth = LiveDepthAt(centre, camera, live, 0, &pixel);
    if (!(depth > 0)) continue;
    const double area = corners.Area();
    const double behind = centre.z() - depth;
    const double margin =
        std::max(kStrayMargin, 3.0 * camera.noise.Sigma(depth));
    result.in_view += area;
    if (behind > margin && behind <= kStrayReach) result.stray += area;
  }
  return result;
}

cv::Mat_<std::uint8_t> ShownPixels(const TriangleMesh& mesh,
                                   const PinholeCamera& camera,
                                   const cv::Mat_<float>& live) {
  Marker marker(camera, live);
  std::vector<char> used(mesh.vertices.size(), false);
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) used[triangle[k]] = true;
    marker.AddInside(TriangleCorners(mesh, triangle));
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) marker.Add(mesh.vertices[i]);
  }
  return marker.Grown();
}

}  // namespace splitfusion
