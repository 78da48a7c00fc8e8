#ifndef SPLITFUSION_LIB_DEFORMATION_MESH_SKINNING_H_
#define SPLITFUSION_LIB_DEFORMATION_MESH_SKINNING_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/deformation/skinning_change.h"

namespace splitfusion {

/// Skinning of a mesh's vertices, kept up to date where the mesh and the graph
/// change: mostly both stay as they were. Always what SkinningIndex gives.
class MeshSkinning {
 public:
  MeshSkinning() = default;
  /// Skins all vertices.
  MeshSkinning(const SkinningIndex& index,
               const std::vector<Eigen::Vector3f>& vertices);

  /// After the mesh was changed: `kept_from` holds for every vertex its index
  /// before, or -1.
  void FollowMesh(const SkinningIndex& index,
                  const std::vector<Eigen::Vector3f>& vertices,
                  const std::vector<int>& kept_from);

  /// After the graph was changed.
  void FollowGraph(const SkinningIndex& index,
                   const std::vector<Eigen::Vector3f>& vertices,
                   const SkinningChange& change);

  /// By vertex.
  const std::vector<Skinning>& skinning() const { return skinning_; }
  /// By vertex, of the same length.
  const std::vector<SkinningSupport>& supports() const { return supports_; }

 private:
  std::vector<Skinning> skinning_;
  std::vector<SkinningSupport> supports_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MESH_SKINNING_H_
