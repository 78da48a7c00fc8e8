#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_CONTACT_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_CONTACT_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {

/// Share of the border pixels of `piece` that touch `body` in 3D: a pixel of
/// `body` within 3 pixels whose depth differs by no more than the noise and a
/// slope of 45 degrees allow. Masks are HxW, 255 inside. A person cut in two
/// by a detector has a long common border, two people who shake hands a short
/// one, and two who cross at different depths none.
double ContactShare(const PointMap& points, const cv::Mat_<uchar>& piece,
                    const cv::Mat_<uchar>& body);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_CONTACT_H_
