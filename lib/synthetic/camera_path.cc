#include "splitfusion/lib/synthetic/camera_path.h"

#include <cmath>

#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/synthetic/hash_noise.h"

namespace splitfusion {
namespace {

using Eigen::Vector3d;

/// Smooth random vector with components in -1..1 and about 3 swings a second.
Vector3d Shake(double time, std::uint32_t seed) {
  Vector3d shake;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3f at(static_cast<float>(6 * time), 10.5f * k, 0.5f);
    shake[k] = 2.0 * ValueNoise(at, seed) - 1.0;
  }
  return shake;
}

double Sway(double time, double period, double phase) {
  return std::sin(2 * kPi<double> * time / period + phase);
}

/// Camera at `place` whose z axis points to `target`, turned by `roll`.
Rigid3d LookAt(const Vector3d& place, const Vector3d& target, double roll) {
  const Vector3d forward = (target - place).normalized();
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Rigid3d pose = Rigid3d::Identity();
  pose.linear() << right, forward.cross(right), forward;
  pose.linear() = pose.linear() *
                  Eigen::AngleAxisd(roll, Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = place;
  return pose;
}

}  // namespace

CameraPath::CameraPath(const SyntheticOptions& options)
    : amplitude_(options.camera_motion), seed_(options.seed * 7919u + 5u) {
  switch (options.scene) {
    case SyntheticSceneKind::kPerson:
      place_ = {0.1, -2.1, 1.25};
      target_ = {0, 0, 0.95};
      break;
    case SyntheticSceneKind::kSoftObject:
      place_ = {0.1, -0.95, 0.5};
      target_ = {0, 0, 0.22};
      break;
    default:
      place_ = {0, -2.05, 1.4};
      target_ = {0, 0.5, 0.88};
  }
}

Rigid3d CameraPath::WorldFromCamera(double time) const {
  const Vector3d sway(0.15 * Sway(time, 3.1, 0.4), 0.07 * Sway(time, 4.3, 1.1),
                      0.07 * Sway(time, 3.7, 2.0));
  const Vector3d gaze(0.14 * Sway(time, 4.1, 2.6), 0,
                      0.07 * Sway(time, 3.3, 0.2));
  const double reach = (target_ - place_).norm() / 2.5;
  const Vector3d place =
      place_ + amplitude_ * (reach * sway + 0.003 * Shake(time, seed_));
  const Vector3d target =
      target_ + amplitude_ * reach * (gaze + 0.012 * Shake(time, seed_ + 1));
  return LookAt(place, target, 0.03 * amplitude_ * Sway(time, 2.7, 0.9));
}

}  // namespace splitfusion
