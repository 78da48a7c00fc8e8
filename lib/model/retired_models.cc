#include "splitfusion/lib/model/retired_models.h"

#include <utility>

namespace splitfusion {

void RetiredModels::Add(TriangleMesh mesh, DeformationGraph graph,
                        MotionLog history) {
  shapes_.Add({std::move(mesh), std::move(graph)});
  histories_.push_back(std::move(history));
}

SurfaceModel RetiredModels::At(int i) const {
  Shape shape = shapes_.At(i);
  return {std::move(shape.mesh), std::move(shape.graph), histories_[i].All()};
}

template <typename Archive>
void RetiredModels::Serialize(Archive* archive) {
  (*archive)(shapes_);
  if constexpr (Archive::kReads) {
    histories_.assign(shapes_.size(), MotionLog(file_));
  }
  for (MotionLog& history : histories_) {
    (*archive)(history);
    if constexpr (Archive::kReads) history.Finish();
  }
}

template void RetiredModels::Serialize(ArchiveWriter*);
template void RetiredModels::Serialize(ArchiveReader*);

}  // namespace splitfusion
