#ifndef SPLITFUSION_LIB_SYNTHETIC_BODY_MODEL_H_
#define SPLITFUSION_LIB_SYNTHETIC_BODY_MODEL_H_

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/synthetic/solid.h"

namespace splitfusion {

/// Pose of one arm.
struct ArmPose {
  Eigen::Vector3d upper{0, 0.2, -1};   ///< Direction of the upper arm.
  Eigen::Vector3d fore{0.2, 0.1, -1};  ///< Direction of the forearm.
};

/// Where one foot stands.
struct FootPose {
  Eigen::Vector3d ankle{0, 0, 0.08};  ///< World, metres.
  double heading = 0;                 ///< About the vertical, radians.
  double pitch = 0;                   ///< Toes down, radians.
};

/// Pose of the body. Body axes: x forward, y to its left, z up. Arm directions
/// are in the chest's axes, with y pointing away from the body on both sides;
/// they need not have unit length.
struct BodyPose {
  Rigid3d world_from_pelvis = Rigid3d::Identity();  ///< Pelvis joint.
  Eigen::Quaterniond abdomen{1, 0, 0, 0};           ///< Relative to the pelvis.
  Eigen::Quaterniond chest{1, 0, 0, 0};  ///< Relative to the abdomen.
  Eigen::Quaterniond head{1, 0, 0, 0};   ///< Relative to the chest.
  std::array<ArmPose, 2> arms;           ///< Left, right.
  std::array<FootPose, 2> feet;          ///< Left, right.
};

/// A person of 1.75 m: one closed mesh over 14 bones, smoothly skinned.
///
/// The mesh is the smooth union of capsules in a rest pose with arms and legs
/// apart. Every vertex starts on the bone of its nearest capsule; the weights
/// then diffuse along the surface, so that nothing jumps from arm to torso.
/// Posing blends dual quaternions (Kavan et al. 2008), which bends joints
/// without the collapse of linear blending; legs reach their ankles by two-bone
/// inverse kinematics.
class BodyModel {
 public:
  /// Number of bones.
  static constexpr int kBones = 14;

  /// Textures of the clothes depend on the seed.
  explicit BodyModel(std::uint32_t seed);

  /// Rest pose with clothes; standing on z = 0, facing x, `instance` as given
  /// in every triangle.
  const TexturedMesh& rest() const { return rest_; }

  /// Vertices in the world for a pose, in the order of the rest mesh; metres.
  std::vector<Eigen::Vector3f> Vertices(const BodyPose& pose) const;

  /// Height of the pelvis joint in the rest pose, metres.
  static double RestPelvisHeight();

 private:
  void ComputeWeights();

  TexturedMesh rest_;
  std::vector<std::array<float, kBones>> weights_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_BODY_MODEL_H_
