#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// Where a surface may have moved to, HxW 8UC1, 255: `seeds` (HxW 8UC1, pixels
/// that are known to be its own) and all that hangs together with them, without
/// a jump in the live depth, over pixels in front of the background or of the
/// surface's own prediction, where no other surface is predicted. A swinging
/// arm is found in this way although neither a detection nor the prediction
/// covers it. `surface` 0: no surface in particular. `blocked` (HxW 8UC1, may
/// be empty) is not entered.
cv::Mat_<uchar> GrowOverUnexplained(int surface, const cv::Mat_<uchar>& seeds,
                                    const cv::Mat_<uchar>& blocked,
                                    const ComparedDepth& compared,
                                    const cv::Mat& depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
