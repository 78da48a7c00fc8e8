#ifndef SPLITFUSION_PIPELINES_OBJECTS_IN_VIEW_H_
#define SPLITFUSION_PIPELINES_OBJECTS_IN_VIEW_H_

#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/render/model_rendering.h"
#include "splitfusion/lib/report/frame_report.h"
#include "splitfusion/pipelines/pipeline_options.h"

namespace splitfusion {

/// Reports of all surfaces but the background, by id: how many live pixels with
/// depth each has, and its Exposure(), which stays 1 if it is not rendered.
/// `rendering`: of the full image's every `stride`-th pixel.
std::vector<SurfaceReport> LookAtObjects(const SurfaceMap& surfaces,
                                         const MeshRendering& rendering,
                                         const LiveView& live, int stride);

/// Whether so much of a surface is in view, in pixels and as a share of its
/// model, that its motion is not that of a strip (--min_tracked_pixels,
/// --min_exposure).
bool IsEnoughInView(const SurfaceReport& report,
                    const PipelineOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_OBJECTS_IN_VIEW_H_
