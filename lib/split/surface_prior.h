#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_PRIOR_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_PRIOR_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

struct GraphCutOptions;
struct PointMap;

/// Between neighbouring pixels of one surface.
constexpr DepthTolerance<float> kSmoothDepth = {0.02f};

/// How strongly each observation speaks for or against a surface, in units of
/// the strongest edge of the graph cut, per pixel.
struct PriorOptions {
  double mask_weight = 0.25;        ///< Core of the detection's mask.
  double prediction_weight = 0.25;  ///< Agreement with the predicted surface.
  double background_weight = 0.15;  ///< Agreement with the background.
  double unexplained_weight = 0.2;  ///< In front of the background.
  double missed_weight = 0.1;     ///< Outside of the prediction, not detected.
  double surface_gate = 0.08;     ///< Metres, beside three times the noise.
  double background_gate = 0.03;  ///< Metres, beside three times the noise.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// The live depth compared with the prediction; all images HxW.
struct ComparedDepth {
  LabelImage labels;  ///< Predicted surface ids, 0 = background or nothing.
  cv::Mat_<uchar> agreement;   ///< With the nearest surface, a DepthState.
  cv::Mat_<uchar> background;  ///< With the background behind all surfaces.
  DepthNoise noise{};          ///< Of the live depth.
};

/// Compares live and predicted depth. `depth`: HxW 32FC1, metres; `noise`: of
/// its sensor.
ComparedDepth CompareDepth(const cv::Mat& depth, const DepthNoise& noise,
                           const SurfacePrediction& prediction,
                           const PriorOptions& options);

/// The observations about one surface in one frame; images are of frame size.
struct SurfaceObservation {
  int surface = 0;       ///< Id in the predicted labels; 0 if it is new.
  cv::Mat_<uchar> mask;  ///< Detected, 255 inside; empty if missed.
  /// 255 inside the masks of other instances.
  cv::Mat_<uchar> others;
  /// 255 where a missed surface may have moved to; see MissedExtent.
  cv::Mat_<uchar> extent;
};

/// Evidence for the graph cut.
struct SurfaceEvidence {
  cv::Rect crop;             ///< Where the surface can be; may be empty.
  cv::Mat_<float> evidence;  ///< Size of the crop; > 0 for the surface.
};

/// Gathers the evidence for one surface: the depth inside or outside of the
/// detector's mask or inside of those of others, and where the live depth
/// agrees with the predicted surface, with another one or with the background.
/// The prediction has no more weight than the mask: it was built from masks,
/// and what it once took up by mistake would confirm itself. Beyond the dilated
/// mask and prediction the background is certain.
SurfaceEvidence GatherEvidence(const SurfaceObservation& observation,
                               const ComparedDepth& compared,
                               const GraphCutOptions& cut,
                               const PriorOptions& options);

/// Pixels (HxW, 255) of a thing that nothing is known of but its detection: its
/// mask, cut along steps and creases of the depth. `color`: HxW 8UC3.
cv::Mat_<uchar> CutOut(const cv::Mat_<uchar>& mask, const PointMap& points,
                       const cv::Mat& color, const GraphCutOptions& cut,
                       const PriorOptions& options);

/// Pixels predicted as `surface` where the live depth agrees, 255.
cv::Mat_<uchar> AgreeingPixels(int surface, const LabelImage& predicted_labels,
                               const cv::Mat_<uchar>& agreement);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_PRIOR_H_
