#ifndef SPLITFUSION_TESTS_TRACKING_PRINTED_PLATE_H_
#define SPLITFUSION_TESTS_TRACKING_PRINTED_PLATE_H_

#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <random>

#include "splitfusion/lib/frame/live_view.h"
#include "support/sample_graphs.h"

namespace splitfusion {

inline const PinholeCamera kSightCamera{320, 240, 260, 260, 160, 120};
inline constexpr double kHalfWidth = 0.25, kHalfHeight = 0.2;  // Metres.

/// Blots of a printed cloth, by place on it.
inline cv::Mat_<std::uint8_t> Print() {
  cv::Mat_<std::uint8_t> print(400, 500, std::uint8_t{128});
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    const int x = static_cast<int>(random() % 500);
    const int y = static_cast<int>(random() % 400);
    cv::circle(print, {x, y}, 3 + static_cast<int>(random() % 8),
               static_cast<int>(random() % 256), cv::FILLED);
  }
  return print;
}

/// A printed plate, surface 1, which lies at `pose` (camera from plate, its
/// middle the origin and its plane z = 0), before a wall at 3 m.
inline LiveView ViewOfPlate(const Rigid3d& pose, bool is_printed = true) {
  const cv::Mat_<std::uint8_t> print = Print();
  cv::Mat_<float> depth(240, 320, 3.0f);
  cv::Mat color(240, 320, CV_8UC3, cv::Scalar::all(30));
  cv::Mat_<std::uint8_t> mask(240, 320, std::uint8_t{0});
  const Rigid3d plate_from_camera = pose.inverse();
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = kSightCamera.BackProject<double>(u, v, 1.0);
      const Eigen::Vector3d direction = plate_from_camera.linear() * ray;
      const double z = -plate_from_camera.translation().z() / direction.z();
      const Eigen::Vector3d p = plate_from_camera * (z * ray);
      if (!(z > 0) || std::abs(p.x()) > kHalfWidth ||
          std::abs(p.y()) > kHalfHeight) {
        continue;
      }
      depth(v, u) = static_cast<float>(z);
      mask(v, u) = 255;
      const int x = static_cast<int>(1000 * (p.x() + kHalfWidth) / 1.001);
      const int y = static_cast<int>(1000 * (p.y() + kHalfHeight) / 1.001);
      const int grey = is_printed ? print(y, x) : 128;
      color.at<cv::Vec3b>(v, u) =
          cv::Vec3b::all(cv::saturate_cast<uchar>(grey));
    }
  }
  LiveView live = MakeLiveView(kSightCamera, depth, color);
  live.labels.setTo(1, mask);
  return live;
}

inline Rigid3d PoseOfPlate(double turn, double x) {
  return Eigen::Translation3d(x, 0.02, 1.2) *
         MakeMotion({0.1, turn, 0}, {0, 0, 0});
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_TRACKING_PRINTED_PLATE_H_
