#ifndef SPLITFUSION_LIB_SPLIT_MASK_SUPPORT_H_
#define SPLITFUSION_LIB_SPLIT_MASK_SUPPORT_H_

#include <map>
#include <opencv2/core.hpp>

#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// Remembers for every pixel of every surface how often detections covered
/// it, so that what a cut once took in by mistake does not confirm itself
/// through the projection, while a limb that one detection forgot is kept.
class MaskSupport {
 public:
  /// Share 0..1 of the recent detections of `surface` that covered a pixel,
  /// HxW; carried over by the mean image motion between the labels of the last
  /// Update() and `predicted_labels`. 0.5 where nothing is known.
  cv::Mat_<float> Predict(int surface,
                          const LabelImage& predicted_labels) const;

  /// Takes in one detected surface: its pixels in this frame and its mask
  /// (both HxW, 255 inside).
  void Update(int surface, const cv::Mat_<uchar>& pixels,
              const cv::Mat_<uchar>& mask, const LabelImage& predicted_labels);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(states_);
  }

 private:
  struct State {
    cv::Mat_<uchar> pixels;
    cv::Mat_<float> support;  // 0 outside of the pixels.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(pixels, support);
    }
  };
  std::map<int, State> states_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_MASK_SUPPORT_H_
