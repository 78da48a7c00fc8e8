#ifndef SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_MESH_H_
#define SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_MESH_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "splitfusion/lib/tsdf/internal/padded_leaf.h"

namespace splitfusion {
namespace internal {

/// The part of a mesh that lies in one block: the points of its cells (a cell
/// is the cube between eight voxels, and belongs to the block of its lowest
/// one) and the faces around its voxels' edges. What openvdb::tools::
/// VolumeToMesh gives, dual marching cubes with OpenVDB's tables, block by
/// block.
struct LeafMesh {
  /// A cell that the surface passes through.
  struct Cell {
    std::uint16_t place;  ///< 64 x + 8 y + z.
    std::uint16_t signs;  ///< OpenVDB's signs and edge flags.
    std::int16_t first;   ///< Its first point.
  };
  /// A corner of a triangle.
  struct Corner {
    std::uint16_t block;  ///< 4 dx + 2 dy + dz: the block before by d.
    std::int16_t vertex;  ///< Of that block.
  };

  std::vector<Cell> cells;
  std::array<std::int16_t, kLeafVoxels> cell_at;  ///< Index in `cells`, or -1.
  std::vector<std::int16_t> vertex_of;  ///< Vertex of a point; -1: unobserved.
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::array<std::uint8_t, 3>> colors;
  std::vector<std::array<Corner, 3>> triangles;
  int begin = -1;  ///< Index of its first vertex in the whole mesh; -1: new.
};

/// Makes points and vertices of a block, without triangles; false if the
/// surface does not pass through it.
bool MakeVertices(const LeafLookup& lookup, const openvdb::Coord& origin,
                  const openvdb::math::Transform& transform, float min_weight,
                  LeafMesh* mesh);

/// Meshes of a block ([0]) and of those before it along the axes; [4 dx + 2 dy
/// + dz] is the one before by d. Null where the surface does not pass.
using LeafMeshes = std::array<const LeafMesh*, 8>;

/// The triangles of the block: those of `meshes[0]` anew.
std::vector<std::array<LeafMesh::Corner, 3>> MakeTriangles(
    const LeafMeshes& meshes);

}  // namespace internal
}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_INTERNAL_LEAF_MESH_H_
