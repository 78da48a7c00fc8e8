#ifndef SPLITFUSION_PIPELINES_COLOR_PASS_H_
#define SPLITFUSION_PIPELINES_COLOR_PASS_H_

#include <functional>
#include <string>

#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/lib/render/depth_residuals.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// A pass over the first `frames` frames that `reader` gives, once their
/// motions are known: colours the vertices of all models from the frames that
/// show them well, see BestViewColors, and finds how far those drawn from
/// meshes lie from the live depth. `reads_ahead`: the next frame is read in
/// a thread of its own. `shown`: called with the number of frames so far.
///
/// `models`: those of `fusion`, with their final motions. `residuals`: by id.
/// @return empty, or a line on frames that cannot be read any more; the colours
///     are then from the others.
std::string ColorFromBestViews(const ImageFolderReader& reader, int frames,
                               const SplitFusion& fusion, bool reads_ahead,
                               const std::function<void(int)>& shown,
                               SurfaceModels* models, ResidualsById* residuals);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_COLOR_PASS_H_
