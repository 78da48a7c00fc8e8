#include "splitfusion/pipelines/pipeline_options.h"

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

PipelineOptions::PipelineOptions() {
  background.tsdf.voxel_size = 0.010;
  background.tsdf.truncation = 0.040;
  object.tsdf.voxel_size = 0.005;
  object.tsdf.truncation = 0.030;
  object.min_piece_area = 0.0025;
  object.looks = 2;
  object.tsdf.max_free_weight = 0.3;
}

void PipelineOptions::Check() const {
  split.Check();
  background.Check();
  object.Check();
  tracker.Check();
  solver.Check();
  ray_cast.Check();
  CheckOption(render_stride >= 1 && render_stride <= 8, "render_stride",
              render_stride, "1..8 pixels");
  for (const auto* stages : {&tracker.rigid, &tracker.non_rigid}) {
    for (const TrackingStage& stage : *stages) {
      CheckOption(stage.stride % render_stride == 0, "render_stride",
                  render_stride,
                  "a divisor of the stride of every tracking stage (" +
                      std::to_string(stage.stride) + ")");
    }
  }
  CheckOption(min_birth_area >= 0 && min_birth_area < 1, "min_birth_area",
              min_birth_area, "a fraction of the image");
  CheckOption(max_lost_young >= 1, "max_lost_young", max_lost_young, ">= 1");
  CheckOption(min_tracked_pixels >= 1, "min_tracked_pixels", min_tracked_pixels,
              ">= 1");
  CheckOption(min_exposure >= 0 && min_exposure <= 1, "min_exposure",
              min_exposure, "0..1");
}

}  // namespace splitfusion
