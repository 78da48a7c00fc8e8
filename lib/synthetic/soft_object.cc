#include "splitfusion/lib/synthetic/soft_object.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>

#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/synthetic/implicit_mesher.h"
#include "splitfusion/lib/synthetic/room.h"

namespace splitfusion {
namespace {

using Eigen::Vector3f;

constexpr float kHeight = 0.45f;  // Metres.
constexpr float kVoxel = 0.011f;  // Metres.
constexpr float kBlend = 0.03f;   // Metres.

RoundCone Cone(const Vector3f& start, const Vector3f& end, float start_radius,
               float end_radius) {
  return {start, end, start_radius, end_radius, /*bone=*/0};
}

std::vector<RoundCone> ToyCones() {
  const float foot = 0.053f;  // Height of its axis: it rests on z = 0.
  std::vector<RoundCone> cones = {
      Cone({0, 0, 0.112f}, {0, 0, 0.2f}, 0.105f, 0.09f),
      Cone({0.005f, 0, 0.335f}, {0.01f, 0, 0.345f}, 0.088f, 0.088f),
      Cone({0.07f, 0, 0.32f}, {0.095f, 0, 0.315f}, 0.035f, 0.03f)};
  for (const float y : {-0.01f, 0.01f}) {
    cones.push_back(
        Cone({0, 7 * y, 0.405f}, {0, 8.5f * y, 0.43f}, 0.032f, 0.03f));
    cones.push_back(
        Cone({0.02f, 9 * y, 0.23f}, {0.09f, 15 * y, 0.18f}, 0.036f, 0.032f));
    cones.push_back(
        Cone({0.06f, 6 * y, foot}, {0.16f, 8.5f * y, foot}, 0.045f, 0.042f));
  }
  return cones;
}

enum ToyMaterial : std::uint16_t { kFur, kBelly, kEye };

std::uint16_t ToyMaterialAt(const Vector3f& p) {
  const float out = std::abs(p.y());
  const Vector3f eye(0.085f, 0.036f, 0.365f);
  if ((Vector3f(p.x(), out, p.z()) - eye).norm() < 0.014f) return kEye;
  const Vector3f nose(0.128f, 0, 0.322f);
  if ((p - nose).norm() < 0.018f) return kEye;
  const bool front = p.x() > 0.07f && out < 0.06f;
  return front ? kBelly : kFur;
}

/// How the toy is deformed at one time.
struct Deformation {
  float bend;       // Angle of the tip against the foot, radians.
  float direction;  // Of the bend, about the vertical, radians.
  float twist;      // Of the tip against the foot, radians.
  float stretch;    // Of the axis; the section keeps the volume.
};

Deformation DeformationAt(double time) {
  const auto t = static_cast<float>(time);
  return {0.75f * std::sin(2 * kPi<float> * 0.31f * t + 0.5f), 0.9f + 0.5f * t,
          0.35f * std::sin(2 * kPi<float> * 0.23f * t),
          1 + 0.13f * std::sin(2 * kPi<float> * 0.47f * t + 0.8f)};
}

/// Carries a rest point along an axis bent to a circular arc.
Vector3f Deform(const Deformation& d, const Vector3f& rest) {
  const float part = rest.z() / kHeight;
  const float squeeze = 1 / std::sqrt(d.stretch);
  const Eigen::AngleAxisf twist(d.twist * part, Vector3f::UnitZ());
  const Vector3f section = squeeze * (twist * Vector3f(rest.x(), rest.y(), 0));
  const float z = d.stretch * rest.z();
  // Slow start at the foot, so that it stays on the table.
  const float angle = d.bend * part * part;
  const float radius_angle = std::abs(angle) > 1e-4f ? angle : 1e-4f;
  const Vector3f side(std::cos(d.direction), std::sin(d.direction), 0);
  const Vector3f hinge = Vector3f::UnitZ().cross(side);
  const Vector3f axis = z / radius_angle *
                        ((1 - std::cos(radius_angle)) * side +
                         std::sin(radius_angle) * Vector3f::UnitZ());
  return axis + Eigen::AngleAxisf(angle, hinge) * section;
}

}  // namespace

SoftObject::SoftObject(const Vector3f& base, std::uint32_t seed) : base_(base) {
  rest_.mesh = MeshRoundCones(ToyCones(), kBlend, kVoxel);
  rest_.materials = {
      {Pattern::kChecker, {0.85f, 0.6f, 0.15f}, {0.5f, 0.25f, 0.1f}, 0.055f},
      {Pattern::kStripes, {0.9f, 0.82f, 0.65f}, {0.35f, 0.55f, 0.6f}, 0.03f},
      {Pattern::kMottled, {0.05f, 0.05f, 0.06f}, {0.12f, 0.1f, 0.1f}, 0.03f}};
  for (Material& material : rest_.materials) material.seed = seed++ + 71;
  rest_.material_at = ToyMaterialAt;
  rest_.triangle_instances.assign(rest_.mesh.triangles.size(), kSoftObjectId);
}

std::vector<Vector3f> SoftObject::Vertices(double time) const {
  const Deformation deformation = DeformationAt(time);
  const Eigen::AngleAxisf yaw(-0.4f * kPi<float>, Vector3f::UnitZ());
  std::vector<Vector3f> vertices(rest_.mesh.vertices.size());
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
    vertices[i] = base_ + yaw * Deform(deformation, rest_.mesh.vertices[i]);
  });
  return vertices;
}

}  // namespace splitfusion
