#ifndef SPLITFUSION_LIB_TSDF_MESH_EXTRACTOR_H_
#define SPLITFUSION_LIB_TSDF_MESH_EXTRACTOR_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Meshes one volume again and again: only blocks that changed since the last
/// time are meshed anew. Gives what ExtractMesh() gives.
class MeshExtractor {
 public:
  /// The most that `min_weight` may be in a volume that is meshed again:
  /// integration does not tell where the weight of a voxel that has more has
  /// changed.
  static constexpr double kMaxMinWeight = 8;  // Speed.

  MeshExtractor();
  ~MeshExtractor();
  /// Takes the meshes of the blocks over.
  MeshExtractor(MeshExtractor&&) noexcept;
  /// Takes the meshes of the blocks over.
  MeshExtractor& operator=(MeshExtractor&&) noexcept;

  /// Triangle mesh of the zero level, see ExtractMesh(). `volume` must be the
  /// one of the calls before, changed by integration only; another one, or
  /// another `min_weight`, needs another extractor.
  ///
  /// @throw InputError if `min_weight` is not finite, or above kMaxMinWeight in
  /// any call but the first.
  TriangleMesh Extract(const TsdfVolume& volume, double min_weight);

  /// For every vertex of the last mesh its index in the mesh before, if it has
  /// not been touched since; else -1.
  const std::vector<int>& kept_from() const { return kept_from_; }

 private:
  struct Blocks;
  std::unique_ptr<Blocks> blocks_;
  std::vector<int> kept_from_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_MESH_EXTRACTOR_H_
