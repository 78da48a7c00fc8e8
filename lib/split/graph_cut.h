#ifndef SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_
#define SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/base/option_list.h"

namespace splitfusion {

struct PointMap;

/// Weights of the 3D min-cut of SplitFusion IV-A.
struct GraphCutOptions {
  /// So far inside of a mask its evidence has its full weight, pixels.
  int core_erosion = 5;
  /// Farther from mask and predicted surface is surely background, pixels.
  int outer_dilation = 12;
  /// A step between neighbours of this many times the axial noise (plus
  /// `step_offset`, metres) lowers their edge to 1/e.
  double step_factor = 3.0;
  double step_offset = 0.003;  ///< Metres.
  /// 1 - cos of the angle between the neighbours' normals that lowers their
  /// edge to 1/e where the surface is concave (two things that touch) ...
  double concave_scale = 0.1;
  double convex_scale = 0.6;  ///< ... and where it is convex.
  /// Difference of colour (0..255, length of the BGR difference) with half of
  /// the effect ...
  double color_scale = 40.0;
  double color_share = 0.5;  ///< ... that colour has at most on an edge, 0..1.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// Evidence at or below it is certain: the pixel is background.
constexpr float kSurelyBackground = -8.0f;

/// Cuts one surface out of a frame: the labelling of the pixels with depth
/// that minimises
///
///   sum_p max(0, -evidence_p) [p foreground] + max(0, evidence_p) [p not]
///     + sum over 8-neighbours (p, q) of w_pq [p and q differ]
///
/// w_pq in 0..1 falls with the distance of each point from the other's tangent
/// plane relative to the noise at that depth, with the angle between normals
/// (more where concave) and a little with the difference of colour
/// (Golovinskiy & Funkhouser 2009, on the organised grid).
///
/// `evidence`: size of `crop`, for the foreground where positive. The result
/// is 8UC1 of the size of `crop`, 255 foreground, 0 also where there is no
/// depth.
cv::Mat_<uchar> CutForeground(const PointMap& points, const cv::Mat& color,
                              const cv::Rect& crop,
                              const cv::Mat_<float>& evidence,
                              const GraphCutOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_GRAPH_CUT_H_
