#include <memory>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/pipelines/frame_tracker.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

/// What a surface is made from.
struct SurfaceOrigin {
  int id = 0;
  SurfaceKind kind = SurfaceKind::kRigid;
  int first_frame = 0;

  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(id, kind, first_frame);
  }
};

template <typename Archive>
void ExpectSameCamera(Archive* archive, const PinholeCamera& camera) {
  ExpectSame(archive, "width", camera.width);
  ExpectSame(archive, "height", camera.height);
  ExpectSame(archive, "fx", camera.fx);
  ExpectSame(archive, "fy", camera.fy);
  ExpectSame(archive, "cx", camera.cx);
  ExpectSame(archive, "cy", camera.cy);
}

}  // namespace

template <typename Archive>
void SplitFusion::Serialize(Archive* archive) {
  archive->Section("split fusion");
  ExpectSameCamera(archive, camera_);
  (*archive)(splitter_, trajectory_, live_.labels, predictors_, *tracker_,
             world_from_given_, standing_, background_state_, camera_misfit_);
  SerializeSurfaces(archive);
}

template <typename Archive>
void SplitFusion::SerializeSurfaces(Archive* archive) {
  std::vector<SurfaceOrigin> origins;
  for (const auto& [id, surface] : surfaces_) {
    origins.push_back({id, surface->kind(), surface->first_frame()});
  }
  (*archive)(origins);
  if constexpr (Archive::kReads) {
    surfaces_.clear();
    for (const auto& [id, kind, first_frame] : origins) {
      surfaces_[id] = std::make_unique<Surface>(id, "", kind, first_frame,
                                                OptionsOf(id), options_.graph);
    }
  }
  for (const auto& [id, surface] : surfaces_) (*archive)(*surface);
}

template void SplitFusion::Serialize(ArchiveWriter*);
template void SplitFusion::Serialize(ArchiveReader*);

}  // namespace splitfusion
