#include "splitfusion/lib/sequence/trajectory.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {

Trajectory ReadTumTrajectory(const std::string& path) {
  Trajectory trajectory;
  for (const TextLine& line : ReadTextLines(path)) {
    std::istringstream words(line.text);
    TimedPose pose;
    Eigen::Vector3d t;
    Eigen::Quaterniond q;
    if (!(words >> pose.timestamp >> t.x() >> t.y() >> t.z() >> q.x() >>
          q.y() >> q.z() >> q.w()) ||
        !t.allFinite() || !(q.norm() > 1e-6)) {
      throw InputError(line.place +
                       ": expected 'timestamp tx ty tz qx qy qz qw', found '" +
                       line.text + "'");
    }
    pose.world_from_camera.linear() = q.normalized().toRotationMatrix();
    pose.world_from_camera.translation() = t;
    trajectory.push_back(pose);
  }
  return trajectory;
}

std::optional<Rigid3d> PoseAt(const Trajectory& trajectory, double timestamp) {
  constexpr double kApart = 0.02;  // Format: seconds.
  const auto nearest =
      std::min_element(trajectory.begin(), trajectory.end(),
                       [timestamp](const TimedPose& a, const TimedPose& b) {
                         return std::abs(a.timestamp - timestamp) <
                                std::abs(b.timestamp - timestamp);
                       });
  if (nearest == trajectory.end() ||
      std::abs(nearest->timestamp - timestamp) > kApart) {
    return std::nullopt;
  }
  return nearest->world_from_camera;
}

void WriteTumHeader(std::ostream& out) {
  out << "# timestamp tx ty tz qx qy qz qw   (world from camera, metres)\n";
}

void WriteTumPose(std::ostream& out, const TimedPose& pose) {
  const Eigen::Vector3d t = pose.world_from_camera.translation();
  const Eigen::Quaterniond q(pose.world_from_camera.linear());
  out << std::fixed << std::setprecision(6) << pose.timestamp
      << std::defaultfloat << std::setprecision(9);
  for (const double v : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    out << ' ' << v;
  }
  out << '\n';
}

void WriteTumTrajectory(const std::string& path, const Trajectory& trajectory) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    WriteTumHeader(out);
    for (const TimedPose& pose : trajectory) WriteTumPose(out, pose);
  });
}

}  // namespace splitfusion
