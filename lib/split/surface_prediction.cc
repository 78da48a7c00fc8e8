#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

SurfacePrediction CompletePrediction(const SurfacePrediction& prediction,
                                     const SurfacePrediction& last,
                                     const std::set<int>& followed,
                                     cv::Size size) {
  if (prediction.labels.empty()) {
    if (!last.labels.empty()) {
      return {
          last.labels.clone(), last.depth, {}, prediction.world_from_camera};
    }
    return {LabelImage(size, 0),
            cv::Mat_<float>(size, 0.0f),
            {},
            prediction.world_from_camera};
  }
  SurfacePrediction completed{prediction.labels.clone(),
                              prediction.depth.clone(), prediction.background,
                              prediction.world_from_camera};
  if (last.labels.empty()) return completed;
  for (const int id : followed) {
    if (cv::countNonZero(prediction.labels == id) > 0) continue;
    const cv::Mat gap = (last.labels == id) & (prediction.labels == 0);
    last.labels.copyTo(completed.labels, gap);
    last.depth.copyTo(completed.depth, gap);
  }
  return completed;
}

}  // namespace splitfusion
