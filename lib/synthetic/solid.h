#ifndef SPLITFUSION_LIB_SYNTHETIC_SOLID_H_
#define SPLITFUSION_LIB_SYNTHETIC_SOLID_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/synthetic/material.h"

namespace splitfusion {

/// A mesh whose triangles have a solid texture and belong to an instance.
struct TexturedMesh {
  TriangleMesh mesh;                ///< Rest pose, metres, with normals.
  std::vector<Material> materials;  ///< Table of textures.
  std::vector<std::uint16_t> triangle_materials;  ///< Index, per triangle;
                                                  ///< unless material_at.
  /// If set: index of the texture at a point of the rest pose (metres).
  std::function<std::uint16_t(const Eigen::Vector3f&)> material_at;
  std::vector<std::uint8_t> triangle_instances;  ///< Id, 0 = background.
};

/// Shape of a solid.
enum class SolidShape { kBox, kCylinder, kSphere };

/// A piece of furniture: a box, a vertical cylinder or an ellipsoid, turned
/// about the vertical.
struct Solid {
  SolidShape shape = SolidShape::kBox;          ///< Kind of body.
  Eigen::Vector3f center{0, 0, 0};              ///< World frame, metres.
  Eigen::Vector3f half_size{0.5f, 0.5f, 0.5f};  ///< Half extents, metres.
  float yaw = 0;               ///< About the vertical z axis, radians.
  std::uint16_t material = 0;  ///< Index into TexturedMesh::materials.
  std::uint8_t instance = 0;   ///< Instance id, 0 = background.
  bool inside_out = false;     ///< Seen from inside: a room.
};

/// True if a world point (metres) lies within the solid (of a room: within its
/// walls).
bool Contains(const Solid& solid, const Eigen::Vector3f& point);

/// Adds the solid's surface, cut into cells of at most `cell` metres (the
/// rasteriser does not clip, so large triangles must not reach behind the
/// camera).
void AppendSolid(const Solid& solid, float cell, TexturedMesh* out);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SOLID_H_
