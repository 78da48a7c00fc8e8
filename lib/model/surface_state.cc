#include <memory>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/model/surface.h"

namespace splitfusion {

template <typename Archive>
void Surface::Serialize(Archive* archive) {
  archive->Section("surface");
  ExpectSame(archive, "id", id_);
  (*archive)(label_, inactive_, volume_, graph_, graph_record_, mesh_, history_,
             refuted_, unconfirmed_, kept_blocks_, retired_);
  if constexpr (Archive::kReads) {
    if (graph_.size() == 0) archive->Fail("a graph without nodes");
    RestoreCaches();
  }
}

void Surface::RestoreCaches() {
  index_ = std::make_unique<SkinningIndex>(graph_,
                                           graph_options_.neighbors_per_point);
  mesh_skinning_ = MeshSkinning(*index_, mesh_.vertices);
  // These two fill themselves when they are used next.
  integrator_ = WarpedIntegrator();
  mesh_extractor_ = MeshExtractor();
}

template void Surface::Serialize(ArchiveWriter*);
template void Surface::Serialize(ArchiveReader*);

}  // namespace splitfusion
