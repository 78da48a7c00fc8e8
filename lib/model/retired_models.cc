#include "splitfusion/lib/model/retired_models.h"

#include <sstream>
#include <string>
#include <utility>

#include "splitfusion/lib/base/archive.h"

namespace splitfusion {

void RetiredModels::Add(const TriangleMesh& mesh, const DeformationGraph& graph,
                        MotionLog history) {
  std::ostringstream stream;
  ArchiveWriter archive(&stream);
  archive(mesh, graph);
  archive.Flush();
  const std::string bytes = stream.str();
  models_.push_back({file_->Append(bytes.data(), bytes.size()), bytes.size(),
                     std::move(history)});
}

void RetiredModels::Read(const Place& place, TriangleMesh* mesh,
                         DeformationGraph* graph) const {
  std::string bytes(place.bytes, '\0');
  file_->Read(place.offset, bytes.data(), bytes.size());
  std::istringstream stream(std::move(bytes));
  ArchiveReader archive(&stream, place.bytes, "temporary file");
  archive(*mesh, *graph);
}

SurfaceModel RetiredModels::At(int i) const {
  SurfaceModel model;
  Read(models_[i], &model.mesh, &model.graph);
  model.history = models_[i].history.All();
  return model;
}

template <typename Archive>
void RetiredModels::Serialize(Archive* archive) {
  const std::uint64_t count = archive->Count(models_.size(), 1);
  if constexpr (Archive::kReads) models_.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    TriangleMesh mesh;
    DeformationGraph graph;
    if constexpr (Archive::kReads) {
      MotionLog history(file_);
      (*archive)(mesh, graph, history);
      history.Finish();
      Add(mesh, graph, std::move(history));
    } else {
      Read(models_[i], &mesh, &graph);
      (*archive)(mesh, graph, models_[i].history);
    }
  }
}

template void RetiredModels::Serialize(ArchiveWriter*);
template void RetiredModels::Serialize(ArchiveReader*);

}  // namespace splitfusion
