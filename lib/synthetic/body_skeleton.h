#ifndef SPLITFUSION_LIB_SYNTHETIC_BODY_SKELETON_H_
#define SPLITFUSION_LIB_SYNTHETIC_BODY_SKELETON_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "splitfusion/lib/synthetic/body_model.h"
#include "splitfusion/lib/synthetic/implicit_mesher.h"

namespace splitfusion {

/// Bones of the body; the left side's come first, the right side's follow at
/// +1.
enum BodyBone {
  kPelvis = 0,    ///< Root.
  kAbdomen = 1,   ///< Belly.
  kChest = 2,     ///< Rib cage and shoulders.
  kHead = 3,      ///< Neck and head.
  kUpperArm = 4,  ///< Left; 5 right.
  kForearm = 6,   ///< Left with hand; 7 right.
  kThigh = 8,     ///< Left; 9 right.
  kShin = 10,     ///< Left; 11 right.
  kFoot = 12,     ///< Left; 13 right.
};

/// Rest position of the joint at which a bone hangs, metres.
Eigen::Vector3d BodyRestJoint(int bone);

/// The bone on which a bone hangs; the pelvis hangs on itself. Parents come
/// before their children.
int BodyParent(int bone);

/// The capsules of the body in the rest pose, each with its bone.
std::vector<RoundCone> BodyCones();

/// World from rest for every bone of a pose.
std::array<Rigid3d, BodyModel::kBones> BodyBoneTransforms(const BodyPose& pose);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_BODY_SKELETON_H_
