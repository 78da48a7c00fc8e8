#ifndef SPLITFUSION_LIB_FRAME_COLOR_REGISTRATION_H_
#define SPLITFUSION_LIB_FRAME_COLOR_REGISTRATION_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/color_camera.h"

namespace splitfusion {

/// Where the colour image, which may have another size, shows what the depth
/// pixels show: HxW, (u, v) in the colour image. Pixels without depth take the
/// depth of the nearest one that has some; pixels that the colour camera does
/// not see, as something is before them (z-buffer), the place of the nearest
/// one in their row or column that it does see and that is not nearer.
///
/// `depth`: HxW, metres, 0 = none, of `depth_camera`.
cv::Mat_<cv::Vec2f> ColorPlaces(const PinholeCamera& depth_camera,
                                const ColorCamera& color_camera,
                                const cv::Mat_<float>& depth);

/// A colour image as the depth camera would see it: bilinear at the places,
/// HxW 8UC3.
cv::Mat RegisterColor(const cv::Mat& color, const cv::Mat_<cv::Vec2f>& places);

/// A mask of the colour image, likewise: nearest, 0 beyond the image.
cv::Mat_<uchar> RegisterMask(const cv::Mat_<uchar>& mask,
                             const cv::Mat_<cv::Vec2f>& places);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_FRAME_COLOR_REGISTRATION_H_
