#ifndef SPLITFUSION_LIB_RENDER_DEPTH_RESIDUALS_H_
#define SPLITFUSION_LIB_RENDER_DEPTH_RESIDUALS_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/render/best_view_colors.h"
#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {

/// How far from the live depth a node has its part of a surface in a frame.
struct DepthResidual {
  std::int32_t frame = 0;  ///< Frame index.
  std::int32_t node = 0;   ///< Index in the graph.
  /// Mean over its vertices in view of the distance along the optical axis,
  /// metres.
  float depth = 0;
};

/// Those of a surface, by frame and node.
using DepthResiduals = std::vector<DepthResidual>;

/// By surface id.
using ResidualsById = std::map<int, DepthResiduals>;

/// Appends those of a frame. A vertex is in view if of all surfaces drawn its
/// own is the nearest there (`raster`, and `live.labels`), and it is not beside
/// an edge. Where the live depth shows something else in front of it
/// (kOneBody), it does not count; where there is nothing as near as that, by
/// the tolerance of that comparison.
///
/// `placed`: the surface in this frame.
void AddDepthResiduals(const BestViewColors& placed, const LiveView& live,
                       const Raster& raster, DepthResiduals* residuals);

/// Writes `residuals.h5`: datasets `residuals/frame`, `node` and `depth`.
///
/// @throw InputError if the file cannot be written.
void WriteResiduals(const std::string& path, const DepthResiduals& residuals);

/// Reads what WriteResiduals wrote; none where there is no file.
///
/// @throw InputError if it is broken.
DepthResiduals ReadResiduals(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_DEPTH_RESIDUALS_H_
