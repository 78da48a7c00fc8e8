#ifndef SPLITFUSION_LIB_SEGMENTATION_YOLACT_PRIORS_H_
#define SPLITFUSION_LIB_SEGMENTATION_YOLACT_PRIORS_H_

#include <opencv2/core.hpp>
#include <vector>

namespace splitfusion {

/// A box of YOLACT, by its centre; parts of the input's width and height.
struct CenterBox {
  float cx = 0;  ///< Centre, right of the left border.
  float cy = 0;  ///< Centre, below the upper border.
  float w = 0;   ///< Width.
  float h = 0;   ///< Height.
};

/// Prior boxes of YOLACT for a square input of `input` pixels: five levels of
/// ceil(n / 2) cells each (69, 35, 18, 9, 5 for 550), scales of 24, 48, 96,
/// 192 and 384 pixels at 550, aspect ratios 1, 1/2, 2. Order: level, row,
/// column, aspect ratio. Heights equal the widths, as the network was trained.
std::vector<CenterBox> YolactPriors(int input);

/// Box of a prior and the network's four numbers for it (variances 0.1, 0.2):
/// c = c_p + 0.1 t_xy w_p,  w = w_p exp(0.2 t_wh).  Corners, parts of the
/// input's width and height.
cv::Rect2f DecodeYolactBox(const CenterBox& prior, const float* location);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_YOLACT_PRIORS_H_
