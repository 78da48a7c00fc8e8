#ifndef SPLITFUSION_LIB_GEOMETRY_TRIANGLE_MESH_H_
#define SPLITFUSION_LIB_GEOMETRY_TRIANGLE_MESH_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace splitfusion {

/// Indexed triangle mesh; triangles are counter-clockwise seen from outside.
/// `normals` and `colors` are empty or have one entry a vertex.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;            ///< Metres.
  std::vector<Eigen::Vector3f> normals;             ///< Unit length, outward.
  std::vector<std::array<std::uint8_t, 3>> colors;  ///< Red, green, blue.
  std::vector<Eigen::Vector3i> triangles;           ///< Vertex indices.

  /// Whether there is no vertex.
  bool empty() const { return vertices.empty(); }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(vertices, normals, colors, triangles);
  }
};

/// Area-weighted vertex normals from the triangles; zero where no triangle is.
std::vector<Eigen::Vector3f> ComputeVertexNormals(const TriangleMesh& mesh);

/// Extra per-vertex scalar properties of a PLY file, by name ("seen", ...).
using PlyProperties = std::map<std::string, std::vector<double>>;

/// Writes a binary little-endian PLY through a temporary name. `extra`:
/// further properties of the vertices, one value each, written as floats.
///
/// @throw InputError if the file cannot be written or an extra property has
///     another number of values than there are vertices.
void WritePly(const std::string& path, const TriangleMesh& mesh,
              const PlyProperties& extra = {});

/// Reads an ascii or binary little-endian PLY; polygons become triangle fans.
/// `extra`, if given, receives every other scalar property of the vertices.
///
/// @throw InputError on a missing, truncated or big-endian file, or on vertex
///     indices out of range; names the file and what is wrong.
TriangleMesh ReadPly(const std::string& path, PlyProperties* extra = nullptr);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_TRIANGLE_MESH_H_
