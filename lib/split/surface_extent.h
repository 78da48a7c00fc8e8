#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// Pixels that only the surface can explain, HxW 8UC1, 255: in front of the
/// background or of the surface's own prediction, where no other surface is
/// predicted. `surface` 0: no surface in particular.
cv::Mat_<uchar> UnexplainedPixels(int surface, const ComparedDepth& compared);

/// `seeds` and all pixels of `open` that hang together with them without a jump
/// in the live depth; HxW 8UC1, 255. A swinging arm is found in this way
/// although neither a detection nor the prediction covers it. `depth`: HxW
/// 32FC1, metres.
cv::Mat_<uchar> GrowOver(const cv::Mat_<uchar>& open,
                         const cv::Mat_<uchar>& seeds, const cv::Mat& depth,
                         const DepthNoise& noise);

/// Where a surface that no detection covers may have moved to: what hangs
/// together with its agreeing pixels and only it can explain, outside of the
/// masks of `others`. All HxW 8UC1, 255; `depth` as in GrowOver().
cv::Mat_<uchar> MissedExtent(int surface, const cv::Mat_<uchar>& others,
                             const ComparedDepth& compared,
                             const cv::Mat& depth);

/// What hangs together with a surface of `labels`, and may be of it though the
/// cut did not give it to the surface: in front of the background, and beside
/// one in `missed` (255: a surface without detection) what is unmapped, too.
/// HxW 8UC1, 255; `depth` as in GrowOver().
cv::Mat_<uchar> Protrusions(const LabelImage& labels,
                            const cv::Mat_<uchar>& missed,
                            const ComparedDepth& compared,
                            const cv::Mat& depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_EXTENT_H_
