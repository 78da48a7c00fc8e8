#include "splitfusion/lib/synthetic/body_model.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/synthetic/body_skeleton.h"
#include "splitfusion/lib/synthetic/implicit_mesher.h"
#include "splitfusion/lib/synthetic/room.h"

namespace splitfusion {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kVoxel = 0.017f;     // Metres.
constexpr float kBlend = 0.05f;      // Metres.
constexpr int kDiffusionSteps = 24;  // About 4 cm along the surface.

enum BodyMaterial : std::uint16_t {
  kSkin,
  kHair,
  kShirt,
  kTrousers,
  kShoes,
  kDark,
};

/// By BodyMaterial.
std::vector<Material> BodyMaterials(std::uint32_t seed) {
  std::vector<Material> materials = {
      {Pattern::kMottled, {0.85f, 0.62f, 0.5f}, {0.7f, 0.46f, 0.36f}, 0.06f},
      {Pattern::kMottled, {0.22f, 0.13f, 0.08f}, {0.4f, 0.26f, 0.15f}, 0.03f},
      {Pattern::kPlaid, {0.15f, 0.25f, 0.6f}, {0.75f, 0.2f, 0.18f}, 0.13f},
      {Pattern::kMottled, {0.14f, 0.22f, 0.3f}, {0.42f, 0.5f, 0.55f}, 0.07f},
      {Pattern::kStripes, {0.25f, 0.2f, 0.18f}, {0.75f, 0.7f, 0.65f}, 0.035f},
      {Pattern::kMottled, {0.08f, 0.07f, 0.07f}, {0.18f, 0.16f, 0.15f}, 0.04f}};
  for (Material& material : materials) material.seed = ++seed;
  return materials;
}

std::uint16_t HeadMaterial(const Vector3f& p) {
  const Vector3f eye(0.09f, 0.036f, 1.645f);
  if ((Vector3f(p.x(), std::abs(p.y()), p.z()) - eye).norm() < 0.016f) {
    return kDark;
  }
  const bool hair = p.z() > 1.7f || (p.x() < 0.015f && p.z() > 1.56f);
  return hair ? kHair : kSkin;
}

/// What covers a point of the rest pose.
std::uint16_t BodyMaterialAt(const Vector3f& p) {
  const float out = std::abs(p.y());
  if (out > 0.45f) return kSkin;
  if (out > 0.27f) return kShirt;
  if (p.z() < 0.085f) return kShoes;
  if (p.z() < 1.0f) return kTrousers;
  if (p.z() < 1.03f) return kDark;
  if (p.z() < 1.475f) return kShirt;
  return HeadMaterial(p);
}

std::vector<std::vector<int>> VertexNeighbors(const TriangleMesh& mesh) {
  std::vector<std::vector<int>> neighbors(mesh.vertices.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbors[t[k]].push_back(t[(k + 1) % 3]);
      neighbors[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  return neighbors;
}

/// Unit dual quaternion of a rigid motion: rotation and half of t times q.
struct DualQuaternion {
  Eigen::Vector4f real = Eigen::Vector4f::Zero();  // x, y, z, w
  Eigen::Vector4f dual = Eigen::Vector4f::Zero();
};

DualQuaternion ToDualQuaternion(const Rigid3d& motion) {
  const Eigen::Quaterniond q(motion.linear());
  const Eigen::Vector3d t = motion.translation();
  const Eigen::Quaterniond d = Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q;
  return {q.coeffs().cast<float>(), (0.5 * d.coeffs()).cast<float>()};
}

/// Applies the normalised blend (Kavan et al. 2008, "Geometric skinning with
/// approximate dual quaternion blending").
Vector3f Apply(const DualQuaternion& blend, const Vector3f& point) {
  const float norm = blend.real.norm();
  const Quaternionf q(Eigen::Vector4f(blend.real / norm));
  const Quaternionf d(Eigen::Vector4f(blend.dual / norm));
  return q * point + 2 * (d * q.conjugate()).vec();
}

}  // namespace

BodyModel::BodyModel(std::uint32_t seed) {
  rest_.mesh = MeshRoundCones(BodyCones(), kBlend, kVoxel);
  rest_.materials = BodyMaterials(seed * 17u);
  rest_.material_at = BodyMaterialAt;
  rest_.triangle_instances.assign(rest_.mesh.triangles.size(), kPersonId);
  ComputeWeights();
}

double BodyModel::RestPelvisHeight() { return BodyRestJoint(kPelvis).z(); }

void BodyModel::ComputeWeights() {
  const TriangleMesh& mesh = rest_.mesh;
  const std::vector<RoundCone> cones = BodyCones();
  weights_.assign(mesh.vertices.size(), {});
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    weights_[i][NearestBone(cones, mesh.vertices[i])] = 1;
  }
  const auto neighbors = VertexNeighbors(mesh);
  auto next = weights_;
  for (int step = 0; step < kDiffusionSteps; ++step) {
    tbb::parallel_for(std::size_t{0}, weights_.size(), [&](std::size_t i) {
      for (int bone = 0; bone < kBones; ++bone) {
        float sum = 0;
        for (const int j : neighbors[i]) sum += weights_[j][bone];
        next[i][bone] = 0.5f * weights_[i][bone] +
                        0.5f * sum / static_cast<float>(neighbors[i].size());
      }
    });
    weights_.swap(next);
  }
}

std::vector<Vector3f> BodyModel::Vertices(const BodyPose& pose) const {
  const auto bones = BodyBoneTransforms(pose);
  std::array<DualQuaternion, kBones> motions;
  for (int bone = 0; bone < kBones; ++bone) {
    motions[bone] = ToDualQuaternion(bones[bone]);
    // q and -q are the same rotation: every bone on the side of its parent.
    if (motions[bone].real.dot(motions[BodyParent(bone)].real) < 0) {
      motions[bone].real *= -1;
      motions[bone].dual *= -1;
    }
  }
  std::vector<Vector3f> vertices(weights_.size());
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
    DualQuaternion blend;
    for (int bone = 0; bone < kBones; ++bone) {
      const float weight = weights_[i][bone];
      if (weight < 1e-4f) continue;
      blend.real += weight * motions[bone].real;
      blend.dual += weight * motions[bone].dual;
    }
    vertices[i] = Apply(blend, rest_.mesh.vertices[i]);
  });
  return vertices;
}

}  // namespace splitfusion
