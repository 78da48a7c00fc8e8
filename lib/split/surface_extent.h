#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// Pixels that only the surface can explain, HxW 8UC1, 255: in front of the
/// background or of the surface's own prediction, where no other surface is
/// predicted. `surface` 0: no surface in particular.
cv::Mat_<uchar> UnexplainedPixels(int surface, const ComparedDepth& compared);

/// Pixels of which nothing was predicted, HxW 8UC1, 255.
cv::Mat_<uchar> UnmappedPixels(const ComparedDepth& compared);

/// `seeds` and all pixels of `open` that hang together with them without a jump
/// in the live depth; HxW 8UC1, 255. A swinging arm is found in this way
/// although neither a detection nor the prediction covers it. `depth`: HxW
/// 32FC1, metres.
cv::Mat_<uchar> GrowOver(const cv::Mat_<uchar>& open,
                         const cv::Mat_<uchar>& seeds, const cv::Mat& depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
