#ifndef SPLITFUSION_LIB_REPORT_DETECTION_PICTURE_H_
#define SPLITFUSION_LIB_REPORT_DETECTION_PICTURE_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Colour image with instance masks over it, HxW 8UC3: each in the LabelColor
/// of its place in the list (from 1) with its outline, its box, class and
/// score; the first on top.
///
/// @param color HxW 8UC3.
/// @throw InputError if a mask has another size than the image.
cv::Mat DetectionPicture(const cv::Mat& color,
                         const std::vector<InstanceMask>& instances);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_DETECTION_PICTURE_H_
