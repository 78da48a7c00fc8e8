#include "splitfusion/lib/tsdf/internal/leaf_mesh.h"

#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>

namespace splitfusion {
namespace internal {
namespace {

// The tables of dual marching cubes, and what goes with them.
namespace tables = openvdb::tools::volume_to_mesh_internal;

openvdb::Coord LocalVoxel(int place) {
  return {place >> 6, (place >> 3) & 7, place & 7};
}

/// Signs of a cell's corners, corrected where a face is ambiguous, and flags of
/// the edges at its lowest corner; 0 if the surface does not pass through.
std::uint16_t CellFlags(const PaddedLeaf& leaf, const openvdb::Coord& at) {
  std::uint8_t signs = tables::evalCellSigns(leaf, at, 0.0f);
  if (signs == 0 || signs == 0xFF) return 0;
  const bool inside = signs & 1;
  int flags = inside ? tables::INSIDE : 0;
  flags |= inside != ((signs & 0x02) != 0) ? tables::XEDGE : 0;
  flags |= inside != ((signs & 0x10) != 0) ? tables::YEDGE : 0;
  flags |= inside != ((signs & 0x08) != 0) ? tables::ZEDGE : 0;
  if (tables::sAmbiguousFace[signs] != 0) {
    tables::correctCellSigns(signs, tables::sAmbiguousFace[signs], leaf, at,
                             0.0f);
  }
  return static_cast<std::uint16_t>(flags | signs);
}

/// Finds the cells that the surface passes through.
void FindCells(const PaddedLeaf& leaf, LeafMesh* mesh) {
  std::uint32_t inside[kLeafSize + 1][kLeafSize + 1];
  for (int x = 0; x <= kLeafSize; ++x) {
    for (int y = 0; y <= kLeafSize; ++y) inside[x][y] = leaf.Inside(x, y) >> 1;
  }
  for (int x = 0; x < kLeafSize; ++x) {
    for (int y = 0; y < kLeafSize; ++y) {
      const std::uint32_t any = inside[x][y] | inside[x + 1][y] |
                                inside[x][y + 1] | inside[x + 1][y + 1];
      const std::uint32_t all = inside[x][y] & inside[x + 1][y] &
                                inside[x][y + 1] & inside[x + 1][y + 1];
      std::uint32_t mixed = (any | any >> 1) & ~(all & all >> 1) & 0xFF;
      for (int z = 0; mixed != 0; ++z, mixed >>= 1) {
        if ((mixed & 1) == 0) continue;
        mesh->cells.push_back({static_cast<std::uint16_t>(x << 6 | y << 3 | z),
                               CellFlags(leaf, {x, y, z}), 0});
      }
    }
  }
}

/// Points of the surface in the cells, metres; numbers the cells' first ones.
std::vector<openvdb::Vec3s> MakePoints(
    const PaddedLeaf& leaf, const openvdb::Coord& origin,
    const openvdb::math::Transform& transform, LeafMesh* mesh) {
  std::vector<openvdb::Vec3s> points;
  mesh->cell_at.fill(-1);
  for (std::size_t i = 0; i < mesh->cells.size(); ++i) {
    LeafMesh::Cell& cell = mesh->cells[i];
    mesh->cell_at[cell.place] = static_cast<std::int16_t>(i);
    cell.first = static_cast<std::int16_t>(points.size());
    const openvdb::Coord at = LocalVoxel(cell.place);
    std::array<double, 8> values;
    tables::getCellVertexValues(leaf, at, values);
    std::array<openvdb::Vec3d, 4> in_cell;
    const std::size_t count = tables::computeCellPoints(
        in_cell, values, static_cast<unsigned char>(cell.signs & 0xFF), 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      points.emplace_back(
          transform.indexToWorld(in_cell[k] + (origin + at).asVec3d()));
    }
  }
  return points;
}

/// Normal at a point of index space, outward.
Eigen::Vector3f Normal(const PaddedLeaf& leaf, const openvdb::Vec3d& p) {
  constexpr double kReach = 0.75;  // Voxels.
  Eigen::Vector3f gradient;
  for (int axis = 0; axis < 3; ++axis) {
    openvdb::Vec3d low = p, high = p;
    low[axis] -= kReach;
    high[axis] += kReach;
    // At the border of what was observed, not beyond the vertex's own cell.
    if (!leaf.Observed(low)) low[axis] = std::floor(p[axis]);
    if (!leaf.Observed(high)) high[axis] = std::floor(p[axis]) + 1;
    const double length = high[axis] - low[axis];
    gradient[axis] =
        static_cast<float>((leaf.Distance(high) - leaf.Distance(low)) / length);
  }
  const float length = gradient.norm();
  return length > 0 ? Eigen::Vector3f(gradient / length)
                    : Eigen::Vector3f(0, 0, 0);
}

std::array<std::uint8_t, 3> Color(const PaddedLeaf& leaf,
                                  const openvdb::Vec3d& p) {
  const openvdb::Vec3s rgb = leaf.Color(p);
  std::array<std::uint8_t, 3> color;
  for (int k = 0; k < 3; ++k) {
    color[k] = static_cast<std::uint8_t>(
        std::clamp(std::lround(rgb[k] * 255), 0l, 255l));
  }
  return color;
}

/// Edge of a cell in OpenVDB's table -> which of the cell's points lies on it.
int PointOfEdge(const LeafMesh::Cell& cell, int edge) {
  const unsigned char* groups = tables::sEdgeGroupTable[cell.signs & 0xFF];
  return groups[0] > 1 ? groups[edge] - 1 : 0;
}

/// A cell that shares a voxel edge: where it is, and the edge's number in it.
struct SharingCell {
  int dx, dy, dz;  // Before the voxel by this.
  int edge;
};

/// The four cells around the edges of a voxel along x, y and z, in turn.
constexpr SharingCell kSharingCells[3][4] = {
    {{0, 0, 0, 1}, {0, 1, 0, 5}, {0, 1, 1, 7}, {0, 0, 1, 3}},
    {{0, 0, 0, 9}, {0, 0, 1, 12}, {1, 0, 1, 11}, {1, 0, 0, 10}},
    {{0, 0, 0, 4}, {0, 1, 0, 8}, {1, 1, 0, 6}, {1, 0, 0, 2}}};
constexpr int kEdgeFlags[3] = {tables::XEDGE, tables::YEDGE, tables::ZEDGE};

/// Vertex of a face; false if it was not observed.
bool FindCorner(const LeafMeshes& meshes, const openvdb::Coord& voxel,
                const SharingCell& sharing, LeafMesh::Corner* corner) {
  const int x = voxel.x() - sharing.dx;
  const int y = voxel.y() - sharing.dy;
  const int z = voxel.z() - sharing.dz;
  const int block = (x < 0 ? 4 : 0) | (y < 0 ? 2 : 0) | (z < 0 ? 1 : 0);
  const LeafMesh& mesh = *meshes[block];
  const LeafMesh::Cell& cell =
      mesh.cells[mesh.cell_at[(x & 7) << 6 | (y & 7) << 3 | (z & 7)]];
  const int vertex =
      mesh.vertex_of[cell.first + PointOfEdge(cell, sharing.edge)];
  *corner = {static_cast<std::uint16_t>(block),
             static_cast<std::int16_t>(vertex)};
  return vertex >= 0;
}

}  // namespace

bool MakeVertices(const LeafLookup& lookup, const openvdb::Coord& origin,
                  const openvdb::math::Transform& transform, float min_weight,
                  LeafMesh* mesh) {
  PaddedLeaf leaf(lookup, origin);
  FindCells(leaf, mesh);
  if (mesh->cells.empty()) return false;
  const std::vector<openvdb::Vec3s> points =
      MakePoints(leaf, origin, transform, mesh);
  leaf.LoadObserved(min_weight);
  mesh->vertex_of.assign(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const openvdb::Vec3d p = transform.worldToIndex(points[i]);
    if (!leaf.Observed(p)) continue;
    mesh->vertex_of[i] = static_cast<std::int16_t>(mesh->vertices.size());
    mesh->vertices.emplace_back(points[i][0], points[i][1], points[i][2]);
    mesh->normals.push_back(Normal(leaf, p));
    mesh->colors.push_back(Color(leaf, p));
  }
  return true;
}

std::vector<std::array<LeafMesh::Corner, 3>> MakeTriangles(
    const LeafMeshes& meshes) {
  std::vector<std::array<LeafMesh::Corner, 3>> triangles;
  for (const LeafMesh::Cell& cell : meshes[0]->cells) {
    const openvdb::Coord voxel = LocalVoxel(cell.place);
    const bool inside = cell.signs & tables::INSIDE;
    for (int axis = 0; axis < 3; ++axis) {
      if ((cell.signs & kEdgeFlags[axis]) == 0) continue;
      // Counter-clockwise seen from the positive side.
      const bool reverse = (axis == 2) == inside;
      std::array<LeafMesh::Corner, 4> quad;
      std::array<bool, 4> observed;
      for (int i = 0; i < 4; ++i) {
        const int k = reverse ? 3 - i : i;
        observed[k] =
            FindCorner(meshes, voxel, kSharingCells[axis][i], &quad[k]);
      }
      if (!observed[0] || !observed[2]) continue;
      if (observed[1]) triangles.push_back({quad[0], quad[1], quad[2]});
      if (observed[3]) triangles.push_back({quad[0], quad[2], quad[3]});
    }
  }
  return triangles;
}

}  // namespace internal
}  // namespace splitfusion
