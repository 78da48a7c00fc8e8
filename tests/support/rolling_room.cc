#include "support/rolling_room.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

namespace splitfusion {
namespace {

/// Floor, wall and side wall: normal . x = distance.
struct RoomPlane {
  Eigen::Vector3d normal;
  double distance;
};
const RoomPlane kPlanes[] = {
    {{0, 1, 0}, 0.9}, {{0, 0, 1}, 2.3}, {{1, 0, 0}, 1.1}};

/// Grey value of the cell of 3 cm that a point lies in.
std::uint8_t GreyOfCell(const Eigen::Vector3d& point) {
  std::uint32_t hash = 2166136261u;
  for (int k = 0; k < 3; ++k) {
    // Off the planes, on which rounding would decide.
    const auto cell =
        static_cast<std::int32_t>(std::floor((point[k] + 0.011) / 0.03));
    hash = (hash ^ static_cast<std::uint32_t>(cell)) * 16777619u;
    hash ^= hash >> 13;
  }
  return static_cast<std::uint8_t>(40 + hash % 176);
}

}  // namespace

Rigid3d RollingRoom::PoseAt(double time) {
  Rigid3d pose = Rigid3d::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(0.25 * std::sin(5 * time), Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(0.12 * std::sin(7 * time), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  pose.translation() << 0.05 * std::sin(4 * time), 0.02 * std::sin(6 * time), 0;
  return pose;
}

Frame RollingRoom::At(int i) const {
  Frame frame;
  frame.index = i;
  frame.timestamp = kInterval * i;
  frame.stem = frame.color_stem = std::to_string(i);
  cv::Mat_<float> depth(camera.height, camera.width, 0.f);
  cv::Mat_<cv::Vec3b> color(camera.height, camera.width);
  tbb::parallel_for(0, camera.height, [&](int v) {
    const double share = (v + 0.5) / camera.height - 0.5;
    const Rigid3d pose = PoseAt(frame.timestamp + share * seconds);
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray = camera.BackProject<double>(u, v, 1);
      const Eigen::Vector3d direction = pose.linear() * ray;
      double nearest = std::numeric_limits<double>::max();
      for (const RoomPlane& plane : kPlanes) {
        const double z =
            (plane.distance - plane.normal.dot(pose.translation())) /
            plane.normal.dot(direction);
        if (z > 0 && z < nearest) nearest = z;
      }
      if (nearest > 5) continue;
      depth(v, u) = static_cast<float>(nearest);
      const std::uint8_t grey = GreyOfCell(pose * (nearest * ray));
      color(v, u) = {grey, grey, grey};
    }
  });
  frame.depth = depth;
  frame.color = color;
  return frame;
}

}  // namespace splitfusion
