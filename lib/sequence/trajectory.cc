#include "splitfusion/lib/sequence/trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

/// A way in the world, and a turn of the camera about its own axes (angle times
/// axis).
using CameraWay = Eigen::Matrix<double, 6, 1>;

CameraWay WayFrom(const TimedPose& a, const TimedPose& b) {
  const Rigid3d &from = a.world_from_camera, &to = b.world_from_camera;
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(from.linear().transpose() * to.linear()));
  CameraWay way;
  way << to.translation() - from.translation(), turn.angle() * turn.axis();
  return way;
}

Eigen::Matrix3d RotationOf(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

}  // namespace

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

Rigid3d PoseAmid(const UnseenMotion& motion, double timestamp) {
  const auto& [earlier, from, to, later] = motion;
  const double time = to.timestamp - from.timestamp;
  if (!(time > 0)) return from.world_from_camera;
  const CameraWay way = WayFrom(from, to);
  // Ways over the whole time at the velocities of its ends.
  const auto at_pace = [&](const TimedPose& a, const TimedPose& b) {
    const double step = b.timestamp - a.timestamp;
    return step > 0 ? CameraWay(WayFrom(a, b) * (time / step)) : way;
  };
  const CameraWay begin = at_pace(earlier, from), end = at_pace(to, later);
  const double s = (timestamp - from.timestamp) / time;
  const CameraWay here = begin * (s * (s - 1) * (s - 1)) +
                         way * (s * s * (3 - 2 * s)) + end * (s * s * (s - 1));
  Rigid3d pose = Rigid3d::Identity();
  pose.linear() = from.world_from_camera.linear() * RotationOf(here.tail<3>());
  pose.translation() = from.world_from_camera.translation() + here.head<3>();
  return pose;
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
