#include "splitfusion/lib/deformation/mesh_skinning.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <utility>

namespace splitfusion {
namespace {

/// Calls visit(i, support) for 0 <= i < count, in parallel. `support` is the
/// call's before.
template <typename Visit>
void ForEachVertex(std::size_t count, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 2048),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      SkinningSupport support;
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        visit(i, &support);
                      }
                    });
}

}  // namespace

MeshSkinning::MeshSkinning(const SkinningIndex& index,
                           const std::vector<Eigen::Vector3f>& vertices)
    : skinning_(vertices.size()), supports_(vertices.size()) {
  ForEachVertex(vertices.size(), [&](std::size_t i, SkinningSupport* support) {
    skinning_[i] = index.Skin(vertices[i], support);
    supports_[i] = *support;
  });
}

void MeshSkinning::FollowMesh(const SkinningIndex& index,
                              const std::vector<Eigen::Vector3f>& vertices,
                              const std::vector<int>& kept_from) {
  std::vector<Skinning> skinning(vertices.size());
  std::vector<SkinningSupport> supports(vertices.size());
  ForEachVertex(vertices.size(), [&](std::size_t i, SkinningSupport* support) {
    const int from = kept_from[i];
    skinning[i] =
        from >= 0 ? skinning_[from] : index.Skin(vertices[i], support);
    supports[i] = from >= 0 ? supports_[from] : *support;
  });
  skinning_ = std::move(skinning);
  supports_ = std::move(supports);
}

void MeshSkinning::FollowGraph(const SkinningIndex& index,
                               const std::vector<Eigen::Vector3f>& vertices,
                               const SkinningChange& change) {
  ForEachVertex(vertices.size(), [&](std::size_t i, SkinningSupport* support) {
    if (change.Keeps(supports_[i])) {
      change.Renumber(&skinning_[i], &supports_[i]);
      return;
    }
    skinning_[i] = index.Skin(vertices[i], support);
    supports_[i] = *support;
  });
}

}  // namespace splitfusion
