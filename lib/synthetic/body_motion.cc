#include "splitfusion/lib/synthetic/body_motion.h"

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/pi.h"

namespace splitfusion {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStart = 0.8;        // Where time 0 is in the first quarter.
constexpr double kWalkSeconds = 2.0;  // Of a quarter of the oval.
constexpr double kQuarterSeconds = 5.0;
constexpr double kFootOffset = 0.11;    // From the path, metres.
constexpr double kAnkleHeight = 0.083;  // Of a planted foot, metres.

double SmoothStep(double x) {
  const double c = std::clamp(x, 0.0, 1.0);
  return c * c * (3 - 2 * c);
}

/// Distance walked (0..1) at time x (0..1): constant speed with soft start and
/// end.
double WalkProgress(double x) {
  constexpr double kRamp = 0.25;
  if (x > 0.5) return 1 - WalkProgress(1 - x);
  const double area = 1 - kRamp;
  return x < kRamp ? std::max(x, 0.0) * std::max(x, 0.0) / (2 * kRamp * area)
                   : (x - kRamp / 2) / area;
}

/// Where a foot is along the quarter, and how far it is lifted.
struct FootState {
  double progress;  // 0..1 of the quarter.
  double lift;      // 0..1.
};

/// The left foot swings in the first and third part of the walk, the right one
/// in the second and fourth; both end side by side.
FootState FootAt(int side, double x) {
  const double first = side == 0 ? 0.0 : 0.25;
  const double middle = side == 0 ? 1.0 / 3 : 2.0 / 3;
  const double a = std::clamp((x - first) / 0.25, 0.0, 1.0);
  const double b = std::clamp((x - first - 0.5) / 0.25, 0.0, 1.0);
  return {middle * SmoothStep(a) + (1 - middle) * SmoothStep(b),
          std::sin(kPi<double> * a) + std::sin(kPi<double> * b)};
}

/// Everything that the pose depends on, at one time.
struct Phase {
  double quarter = 0;  // Number of the quarter plus the part walked.
  double base = 0;     // Number of the quarter.
  double walked = 1;   // Time of the walk, 0..1.
  double wave = 0;     // Strength of the gestures, 0..1.
  double bend = 0;
  double raise = 0;
  double squat = 0;
  double turn = 0;
  double seconds = 0;
};

Phase PhaseAt(double time, bool walks) {
  const double t = time + kStart;
  Phase phase;
  phase.seconds = t;
  phase.base = std::floor(t / kQuarterSeconds);
  const double in_quarter = t - phase.base * kQuarterSeconds;
  const int number = static_cast<int>(phase.base) % 4;
  phase.walked = walks ? std::min(in_quarter / kWalkSeconds, 1.0) : 1.0;
  const double wave =
      SmoothStep(in_quarter) * SmoothStep((3.3 - in_quarter) / 1.8);
  phase.wave = number % 2 == 0 ? wave : 0;
  const double part = std::clamp((in_quarter - 1.9) / 2.8, 0.0, 1.0);
  const double strength = std::pow(std::sin(kPi<double> * part), 2);
  phase.bend = number == 0 || number == 3 ? strength : 0;
  phase.raise = number == 1 ? strength : 0;
  phase.squat = number == 2 ? strength : 0;
  phase.turn = number == 3 ? strength : 0.6 * phase.raise;
  phase.quarter = walks ? phase.base + WalkProgress(phase.walked) : 0;
  if (!walks) phase.base = -1;
  return phase;
}

/// The oval: a place and the heading along it, world frame.
struct PathPoint {
  Vector2d position;
  double heading;
};

class Path {
 public:
  explicit Path(bool walks) : walks_(walks) {}

  PathPoint At(double quarter) const {
    if (!walks_) return {Vector2d::Zero(), -kPi<double> / 2};
    const double angle = 0.75 * kPi<double> + 0.5 * kPi<double> * quarter;
    const Vector2d center(0.36, 0.36), radius(0.56, 0.4);
    const Vector2d tangent(-radius.x() * std::sin(angle),
                           radius.y() * std::cos(angle));
    // The branch of the arc tangent that is continuous along the path.
    double heading = std::atan2(tangent.y(), tangent.x());
    const double expected = angle + 0.5 * kPi<double>;
    heading +=
        2 * kPi<double> * std::round((expected - heading) / (2 * kPi<double>));
    return {center + Vector2d(radius.x() * std::cos(angle),
                              radius.y() * std::sin(angle)),
            heading};
  }

 private:
  bool walks_;
};

FootPose PoseFoot(int side, const Phase& phase, const Path& path) {
  const FootState state = FootAt(side, phase.walked);
  const PathPoint at = path.At(phase.base + state.progress);
  const double offset = side == 0 ? kFootOffset : -kFootOffset;
  FootPose foot;
  foot.ankle << at.position + offset * Vector2d(-std::sin(at.heading),
                                                std::cos(at.heading)),
      kAnkleHeight + 0.08 * state.lift;
  foot.heading = at.heading;
  foot.pitch = 0.25 * state.lift;
  return foot;
}

/// Unit vector on the arc from `from` (at 0) to `to` (at 1).
Vector3d Turned(const Vector3d& from, const Vector3d& to, double part) {
  const Quaterniond all = Quaterniond::FromTwoVectors(from, to);
  return Quaterniond::Identity().slerp(part, all) * from.normalized();
}

ArmPose PoseArm(int side, const Phase& phase, double swing) {
  const double beat = std::sin(2 * kPi<double> * 0.9 * phase.seconds);
  const double idle = 0.06 * std::sin(1.7 * phase.seconds + side);
  ArmPose arm;
  arm.upper = Vector3d(0.75 * swing + idle, 0.3, -1);
  arm.fore = Vector3d(0.3 + 0.9 * swing + idle, 0.18, -1);
  const auto gesture = [&arm](double strength, const Vector3d& upper,
                              const Vector3d& fore) {
    arm.upper = Turned(arm.upper, upper, strength);
    arm.fore = Turned(arm.fore, fore, strength);
  };
  if (side == 1) {
    gesture(phase.wave, {0.35, 0.9, 0.05}, {0.4, 0.35 + 0.45 * beat, 1});
  }
  gesture(phase.bend, {0.75, 0.35, -0.75}, {0.9, 0.1, -0.5});
  gesture(phase.raise, {0.35, 0.9, 0.55}, {0.25, 0.25, 1});
  gesture(phase.squat, {0.9, 0.3, -0.1}, {1, 0.05, 0.15});
  return arm;
}

Quaterniond PitchYawRoll(double pitch, double yaw, double roll) {
  return AngleAxisd(yaw, Vector3d::UnitZ()) *
         AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

/// Upper body: the spine shares bending, leaning and turning.
void PoseSpine(const Phase& phase, double swing, BodyPose* pose) {
  const double breath = 0.015 * std::sin(2.1 * phase.seconds);
  const double lean = 0.2 * phase.raise * std::sin(2.5 * phase.seconds);
  pose->abdomen = PitchYawRoll(0.3 * phase.bend + 0.15 * phase.squat,
                               0.25 * phase.turn + 0.08 * swing, lean);
  pose->chest = PitchYawRoll(0.3 * phase.bend + breath,
                             0.25 * phase.turn + 0.1 * swing, lean);
  pose->head =
      PitchYawRoll(-0.35 * phase.bend - 0.1 * phase.squat,
                   0.3 * std::sin(0.8 * phase.seconds) - 0.15 * swing, 0);
}

void PosePelvis(const Phase& phase, const Path& path, double swing,
                BodyPose* pose) {
  const PathPoint at = path.At(phase.quarter);
  const Quaterniond turned(
      AngleAxisd(at.heading - 0.12 * swing, Vector3d::UnitZ()));
  const double back = 0.12 * phase.bend + 0.1 * phase.squat;
  const double drop =
      0.035 + 0.06 * std::abs(swing) + 0.05 * phase.bend + 0.28 * phase.squat;
  const double sway = 0.03 * std::sin(4 * kPi<double> * phase.walked);
  Rigid3d& pelvis = pose->world_from_pelvis;
  pelvis.linear() =
      (turned * PitchYawRoll(0.35 * phase.bend + 0.2 * phase.squat, 0, 0))
          .toRotationMatrix();
  pelvis.translation() << at.position, BodyModel::RestPelvisHeight() - drop;
  pelvis.translation() += turned * Vector3d(-back, sway, 0);
}

}  // namespace

BodyPose BodyMotion::PoseAt(double time) const {
  const Phase phase = PhaseAt(time, walks_);
  const Path path(walks_);
  // Right foot before left: the left arm swings forwards.
  const double swing =
      FootAt(1, phase.walked).progress - FootAt(0, phase.walked).progress;
  BodyPose pose;
  PosePelvis(phase, path, swing, &pose);
  PoseSpine(phase, swing, &pose);
  for (const int side : {0, 1}) {
    pose.arms[side] = PoseArm(side, phase, side == 0 ? swing : -swing);
    pose.feet[side] = PoseFoot(side, phase, path);
  }
  return pose;
}

}  // namespace splitfusion
