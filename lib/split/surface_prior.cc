#include "splitfusion/lib/split/surface_prior.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/split/graph_cut.h"

namespace splitfusion {
namespace {

/// Distance to the border of a mask, pixels: positive inside.
cv::Mat_<float> SignedDistance(const cv::Mat_<uchar>& mask) {
  cv::Mat inside, outside;
  cv::distanceTransform(mask, inside, cv::DIST_L2, 3);
  cv::distanceTransform(~mask, outside, cv::DIST_L2, 3);
  return inside - outside;
}

cv::Mat Disk(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE,
                                   cv::Size(2 * radius + 1, 2 * radius + 1));
}

/// Bounding box grown by `margin` pixels, within the image.
cv::Rect GrownBox(const cv::Mat& mask, int margin) {
  const cv::Rect box = cv::boundingRect(mask);
  if (box.area() == 0) return {};
  const cv::Rect grown(box.x - margin, box.y - margin, box.width + 2 * margin,
                       box.height + 2 * margin);
  return grown & cv::Rect(0, 0, mask.cols, mask.rows);
}

/// Evidence of one crop, pixel by pixel.
class Evidence {
 public:
  Evidence(const SurfaceObservation& observation, const cv::Rect& crop,
           const ComparedDepth& compared, const GraphCutOptions& cut,
           const PriorOptions& options)
      : surface_(observation.surface),
        detected_(!observation.mask.empty()),
        labels_(compared.labels(crop)),
        agreement_(compared.agreement(crop)),
        background_(compared.background(crop)),
        cut_(cut),
        options_(options) {
    if (!observation.others.empty()) others_ = observation.others(crop);
  }

  cv::Mat_<float> Compute(const cv::Mat_<uchar>& reference,
                          const cv::Mat_<uchar>& possible) const {
    const cv::Mat_<float> distance = SignedDistance(reference);
    const cv::Mat_<float> reach = SignedDistance(possible);
    cv::Mat_<float> evidence(reference.size());
    for (int v = 0; v < evidence.rows; ++v) {
      for (int u = 0; u < evidence.cols; ++u) {
        const bool far_out = reach(v, u) < -cut_.outer_dilation;
        evidence(v, u) =
            far_out ? kSurelyBackground
                    : static_cast<float>(OfMasks(v, u, distance(v, u)) +
                                         OfPrediction(v, u));
      }
    }
    return evidence;
  }

 private:
  /// What is in the mask of another one says no more than that it is not in
  /// its own: both are the detector's word on one pixel.
  double OfMasks(int v, int u, float distance) const {
    const double own = OfMask(distance);
    return OfOther(v, u) ? std::max(own, 0.0) - options_.mask_weight : own;
  }

  bool OfOther(int v, int u) const {
    return !others_.empty() && others_(v, u) != 0;
  }

  double OfMask(float distance) const {
    const double inside =
        detected_ ? options_.mask_weight : options_.missed_weight;
    if (distance > 0) {
      return inside * std::min(1.0, distance / double(cut_.core_erosion));
    }
    return inside * std::max(-1.0, distance / double(cut_.outer_dilation));
  }

  double OfPrediction(int v, int u) const {
    const int label = labels_(v, u);
    const bool own = surface_ > 0 && label == surface_;
    switch (static_cast<DepthState>(agreement_(v, u))) {
      case DepthState::kObserved:
        if (own) return options_.prediction_weight + OfBackground(v, u);
        return label == 0 ? -options_.background_weight
                          : -options_.prediction_weight;
      case DepthState::kFree:
        return own ? -options_.prediction_weight : 0.0;
      case DepthState::kOccluded:
        return own || label == 0 ? options_.unexplained_weight : 0.0;
      default:
        return 0.0;
    }
  }

  /// What lies behind a surface tells, too: a foot stands in front of the floor
  /// that was mapped, and a piece of floor that was taken up with it does not.
  /// In the mask of another one it says nothing, as that stands before it, too.
  double OfBackground(int v, int u) const {
    if (OfOther(v, u)) return 0.0;
    switch (static_cast<DepthState>(background_(v, u))) {
      case DepthState::kObserved:
        return -options_.background_weight;
      case DepthState::kOccluded:
        return options_.unexplained_weight;
      default:
        return 0.0;
    }
  }

  const int surface_;
  const bool detected_;
  const LabelImage labels_;
  const cv::Mat_<uchar> agreement_;
  const cv::Mat_<uchar> background_;
  cv::Mat_<uchar> others_;
  const GraphCutOptions& cut_;
  const PriorOptions& options_;
};

}  // namespace

void PriorOptions::List(OptionList* list) {
  Range weight{0, 4};
  list->Number("prediction_weight", &prediction_weight, weight, "",
               "Weight of live depth that agrees with a projected surface.");
  list->Number("background_weight", &background_weight, weight, "",
               "Weight of live depth that agrees with the background.");
  list->Number("unexplained_weight", &unexplained_weight, weight, "",
               "Weight of live depth in front of the background.");
  list->Number("missed_weight", &missed_weight, weight, "",
               "Weight against pixels outside of a surface that was not "
               "detected.");
  weight.above_low = true;
  list->Number("mask_weight", &mask_weight, weight, "",
               "Weight of the core of a mask, in edges of the cut.");
  list->Number("surface_gate", &surface_gate, Range::Above(0), "metres",
               "Depth agrees with a surface within this and three times the "
               "noise.");
  list->Number("background_gate", &background_gate, Range::Above(0), "metres",
               "The same for the background.");
}

ComparedDepth CompareDepth(const cv::Mat& depth, const DepthNoise& noise,
                           const SurfacePrediction& prediction,
                           const PriorOptions& options) {
  ComparedDepth compared;
  compared.labels = prediction.labels;
  compared.noise = noise;
  compared.agreement.create(depth.size());
  compared.background.create(depth.size());
  const bool has_background = !prediction.background.empty();
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float live = depth.at<float>(v, u);
      const DepthTolerance<double> background = {options.background_gate};
      const DepthTolerance<double> surface = {options.surface_gate};
      const auto& gate = prediction.labels(v, u) > 0 ? surface : background;
      compared.agreement(v, u) = static_cast<uchar>(
          ClassifyDepth(live, prediction.depth(v, u), gate.At(live, noise)));
      compared.background(v, u) = static_cast<uchar>(
          ClassifyDepth(live, has_background ? prediction.background(v, u) : 0,
                        background.At(live, noise)));
    }
  });
  return compared;
}

cv::Mat_<uchar> AgreeingPixels(int surface, const LabelImage& predicted_labels,
                               const cv::Mat_<uchar>& agreement) {
  return (predicted_labels == surface) &
         (agreement == static_cast<int>(DepthState::kObserved));
}

SurfaceEvidence GatherEvidence(const SurfaceObservation& observation,
                               const ComparedDepth& compared,
                               const GraphCutOptions& cut,
                               const PriorOptions& options) {
  cv::Mat_<uchar> predicted =
      observation.surface > 0
          ? AgreeingPixels(observation.surface, compared.labels,
                           compared.agreement)
          : cv::Mat_<uchar>(compared.agreement.size(), uchar(0));
  if (!observation.extent.empty()) predicted |= observation.extent;
  const bool detected = !observation.mask.empty();
  const cv::Mat_<uchar> possible =
      detected ? cv::Mat_<uchar>(observation.mask | predicted) : predicted;
  SurfaceEvidence result;
  result.crop = GrownBox(possible, cut.outer_dilation + 2);
  if (result.crop.area() == 0) return result;
  cv::Mat reference =
      (detected ? observation.mask : predicted)(result.crop).clone();
  cv::morphologyEx(reference, reference, cv::MORPH_CLOSE, Disk(2));
  const Evidence evidence(observation, result.crop, compared, cut, options);
  result.evidence = evidence.Compute(reference, possible(result.crop));
  return result;
}

cv::Mat_<uchar> CutOut(const cv::Mat_<uchar>& mask, const PointMap& points,
                       const cv::Mat& color, const GraphCutOptions& cut,
                       const PriorOptions& options) {
  ComparedDepth unknown;
  unknown.labels = LabelImage(mask.size(), 0);
  unknown.agreement = unknown.background =
      cv::Mat_<uchar>(mask.size(), static_cast<uchar>(DepthState::kUnmeasured));
  const SurfaceEvidence evidence =
      GatherEvidence({0, mask, {}, {}}, unknown, cut, options);
  cv::Mat_<uchar> thing(mask.size(), uchar(0));
  if (evidence.crop.area() == 0) return thing;
  CutForeground(points, color, evidence.crop, evidence.evidence, cut)
      .copyTo(thing(evidence.crop));
  return thing;
}

}  // namespace splitfusion
