#include "splitfusion/lib/model/retired_models.h"

#include <cstdint>
#include <utility>

#include "splitfusion/lib/base/archive.h"

namespace splitfusion {

void RetiredModels::Add(TriangleMesh mesh, DeformationGraph graph,
                        MotionLog history) {
  models_.Add({std::move(mesh), std::move(graph), std::move(history)});
}

TrackedModel RetiredModels::At(int i) const {
  return models_.At(i, {{}, {}, MotionLog(file_)});
}

template <typename Archive>
void RetiredModels::Serialize(Archive* archive) {
  const std::uint64_t count = archive->Count(size(), 1);
  if constexpr (Archive::kReads) models_ = SpooledList<TrackedModel>(file_);
  for (std::uint64_t i = 0; i < count; ++i) {
    TrackedModel model{{}, {}, MotionLog(file_)};
    if constexpr (!Archive::kReads) model = At(static_cast<int>(i));
    // With its motions: a checkpoint has no other file.
    (*archive)(model.mesh, model.graph, model.history);
    if constexpr (Archive::kReads) {
      model.history.Finish();
      models_.Add(model);
    }
  }
}

template void RetiredModels::Serialize(ArchiveWriter*);
template void RetiredModels::Serialize(ArchiveReader*);

}  // namespace splitfusion
