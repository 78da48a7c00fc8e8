#include "splitfusion/lib/synthetic/body_skeleton.h"

#include <algorithm>
#include <cmath>

namespace splitfusion {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kUpperArmLength = 0.28;  // Metres, as all lengths here.
constexpr double kForearmLength = 0.25;
constexpr double kHandLength = 0.15;
constexpr double kThighLength = 0.43;
constexpr double kShinLength = 0.43;
constexpr double kAnkleAtRest = 0.08;

/// +1 for the left side, -1 for the right.
double SideSign(int side) { return side == 0 ? 1 : -1; }

/// Rest directions: arms 50 degrees and legs 6 degrees from the vertical.
Vector3d RestArmDirection(int side) {
  return Vector3d(0, 0.766 * SideSign(side), -0.643).normalized();
}
Vector3d RestLegDirection(int side) {
  return Vector3d(0, 0.1045 * SideSign(side), -0.9945).normalized();
}

Vector3d RestHip(int side) {
  return {0, 0.1 * SideSign(side),
          kAnkleAtRest + 0.9945 * (kThighLength + kShinLength)};
}

RoundCone Cone(int bone, const Vector3d& start, const Vector3d& end,
               double start_radius, double end_radius) {
  return {start.cast<float>(), end.cast<float>(),
          static_cast<float>(start_radius), static_cast<float>(end_radius),
          bone};
}

void AppendArm(int side, std::vector<RoundCone>* cones) {
  const Vector3d along = RestArmDirection(side);
  const Vector3d shoulder = BodyRestJoint(kUpperArm + side);
  const Vector3d elbow = BodyRestJoint(kForearm + side);
  const Vector3d wrist = elbow + kForearmLength * along;
  const Vector3d thumb = wrist + 0.07 * along + Vector3d(0.05, 0, 0.01);
  cones->push_back(Cone(kUpperArm + side, shoulder, elbow, 0.062, 0.046));
  cones->push_back(Cone(kForearm + side, elbow, wrist, 0.046, 0.033));
  cones->push_back(Cone(kForearm + side, wrist + 0.02 * along,
                        wrist + kHandLength * along, 0.04, 0.028));
  cones->push_back(
      Cone(kForearm + side, wrist + 0.02 * along, thumb, 0.02, 0.016));
}

void AppendLeg(int side, std::vector<RoundCone>* cones) {
  const Vector3d hip = BodyRestJoint(kThigh + side);
  const Vector3d knee = BodyRestJoint(kShin + side);
  const Vector3d ankle = BodyRestJoint(kFoot + side);
  cones->push_back(Cone(kThigh + side, hip, knee, 0.088, 0.06));
  cones->push_back(Cone(kShin + side, knee, ankle, 0.06, 0.042));
  cones->push_back(Cone(kFoot + side, ankle + Vector3d(-0.04, 0, -0.035),
                        ankle + Vector3d(0.15, 0, -0.045), 0.045, 0.035));
}

Quaterniond Between(const Vector3d& from, const Vector3d& to) {
  return Quaterniond::FromTwoVectors(from, to);
}

/// The motion that turns a bone about its joint and puts the joint in place.
Rigid3d BoneTransform(int bone, const Quaterniond& world_from_rest,
                      const Vector3d& joint_in_world) {
  Rigid3d transform = Rigid3d::Identity();
  transform.linear() = world_from_rest.toRotationMatrix();
  transform.translation() =
      joint_in_world - transform.linear() * BodyRestJoint(bone);
  return transform;
}

using BoneTransforms = std::array<Rigid3d, BodyModel::kBones>;

void PoseArm(int side, const ArmPose& arm, BoneTransforms* bones) {
  const Rigid3d& chest = (*bones)[kChest];
  const Vector3d mirror(1, SideSign(side), 1);
  const Vector3d rest = RestArmDirection(side);
  const Quaterniond upper_local = Between(rest, mirror.cwiseProduct(arm.upper));
  const Quaterniond fore_local =
      upper_local *
      Between(rest, upper_local.inverse() * mirror.cwiseProduct(arm.fore));
  const Quaterniond chest_rotation(chest.linear());
  const int upper = kUpperArm + side, fore = kForearm + side;
  (*bones)[upper] = BoneTransform(upper, chest_rotation * upper_local,
                                  chest * BodyRestJoint(upper));
  (*bones)[fore] = BoneTransform(fore, chest_rotation * fore_local,
                                 (*bones)[upper] * BodyRestJoint(fore));
}

/// Knee of a two-bone leg that reaches from hip towards ankle, bent towards
/// `forward`.
Vector3d SolveKnee(const Vector3d& hip, const Vector3d& ankle,
                   const Vector3d& forward) {
  const Vector3d reach = ankle - hip;
  const double distance =
      std::clamp(reach.norm(), 0.2, kThighLength + kShinLength - 1e-4);
  const Vector3d along = reach.normalized();
  const double a = (distance * distance + kThighLength * kThighLength -
                    kShinLength * kShinLength) /
                   (2 * distance);
  const double height =
      std::sqrt(std::max(0.0, kThighLength * kThighLength - a * a));
  const Vector3d bend = (forward - forward.dot(along) * along).normalized();
  return hip + a * along + height * bend;
}

void PoseLeg(int side, const FootPose& foot, BoneTransforms* bones) {
  const int thigh = kThigh + side, shin = kShin + side, sole = kFoot + side;
  const Vector3d hip = (*bones)[kPelvis] * BodyRestJoint(thigh);
  const Quaterniond yaw(Eigen::AngleAxisd(foot.heading, Vector3d::UnitZ()));
  const Vector3d forward = yaw * Vector3d::UnitX();
  const Vector3d knee = SolveKnee(hip, foot.ankle, forward);
  const Vector3d rest = RestLegDirection(side);
  const Quaterniond thigh_rotation =
      yaw * Between(rest, yaw.inverse() * (knee - hip));
  const Quaterniond shin_rotation =
      thigh_rotation *
      Between(rest, thigh_rotation.inverse() * (foot.ankle - knee));
  (*bones)[thigh] = BoneTransform(thigh, thigh_rotation, hip);
  (*bones)[shin] = BoneTransform(shin, shin_rotation, knee);
  // A leg that is too short lifts its foot rather than stretching.
  (*bones)[sole] = BoneTransform(
      sole, yaw * Quaterniond(Eigen::AngleAxisd(foot.pitch, Vector3d::UnitY())),
      (*bones)[shin] * BodyRestJoint(sole));
}

}  // namespace

Vector3d BodyRestJoint(int bone) {
  const int side = bone & 1;
  const Vector3d shoulder(0, 0.18 * SideSign(side), 1.405);
  switch (bone < kUpperArm ? bone : bone & ~1) {
    case kPelvis:
      return {0, 0, 0.96};
    case kAbdomen:
      return {0, 0, 1.06};
    case kChest:
      return {0, 0, 1.21};
    case kHead:
      return {0, 0, 1.48};
    case kUpperArm:
      return shoulder;
    case kForearm:
      return shoulder + kUpperArmLength * RestArmDirection(side);
    case kThigh:
      return RestHip(side);
    case kShin:
      return RestHip(side) + kThighLength * RestLegDirection(side);
    default:
      return RestHip(side) +
             (kThighLength + kShinLength) * RestLegDirection(side);
  }
}

int BodyParent(int bone) {
  if (bone < kUpperArm) return std::max(0, bone - 1);
  if (bone < kForearm) return kChest;
  return bone == kThigh || bone == kThigh + 1 ? kPelvis : bone - 2;
}

std::vector<RoundCone> BodyCones() {
  std::vector<RoundCone> cones = {
      Cone(kPelvis, {-0.01, -0.07, 0.95}, {-0.01, 0.07, 0.95}, 0.115, 0.115),
      Cone(kAbdomen, {0, -0.05, 1.1}, {0, 0.05, 1.1}, 0.108, 0.108),
      Cone(kChest, {0, -0.075, 1.28}, {0, 0.075, 1.28}, 0.118, 0.118),
      Cone(kChest, {-0.01, -0.13, 1.39}, {-0.01, 0.13, 1.39}, 0.07, 0.07),
      Cone(kHead, {0, 0, 1.46}, {0.01, 0, 1.56}, 0.055, 0.055),
      Cone(kHead, {0.02, 0, 1.59}, {0, 0, 1.655}, 0.08, 0.095),
      Cone(kHead, {0.095, 0, 1.62}, {0.112, 0, 1.595}, 0.012, 0.016)};
  for (const int side : {0, 1}) {
    AppendArm(side, &cones);
    AppendLeg(side, &cones);
  }
  return cones;
}

BoneTransforms BodyBoneTransforms(const BodyPose& pose) {
  BoneTransforms bones;
  Quaterniond rotation(pose.world_from_pelvis.linear());
  bones[kPelvis] =
      BoneTransform(kPelvis, rotation, pose.world_from_pelvis.translation());
  const Quaterniond spine[] = {pose.abdomen, pose.chest, pose.head};
  for (int i = 0; i < 3; ++i) {
    rotation = rotation * spine[i];
    bones[kAbdomen + i] =
        BoneTransform(kAbdomen + i, rotation,
                      bones[kPelvis + i] * BodyRestJoint(kAbdomen + i));
  }
  for (const int side : {0, 1}) {
    PoseArm(side, pose.arms[side], &bones);
    PoseLeg(side, pose.feet[side], &bones);
  }
  return bones;
}

}  // namespace splitfusion
