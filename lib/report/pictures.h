#ifndef SPLITFUSION_LIB_REPORT_PICTURES_H_
#define SPLITFUSION_LIB_REPORT_PICTURES_H_

#include <opencv2/core.hpp>

namespace splitfusion {

/// Fixed, well-spaced colour (BGR) of a surface id; 0 (the background) is grey.
cv::Vec3b LabelColor(int id);

/// Normals of the camera frame as colours, HxW 8UC3 BGR: red = (1 + x) / 2,
/// green = (1 - y) / 2, blue = (1 - z) / 2 of full scale, so that a surface
/// facing the camera is light blue and one facing up is green. White where the
/// normal is zero or not finite.
///
/// @param normals HxW 32FC3, unit length, camera frame.
/// @throw InputError if the type is another.
cv::Mat NormalPicture(const cv::Mat& normals);

/// Depth as colours (turbo map, 0.4 m = blue, 5 m = red), HxW 8UC3; values
/// beyond the range take the colour of its end, pixels without depth are black.
///
/// @param depth HxW 32FC1, metres, 0 = none.
/// @throw InputError if the type is another.
cv::Mat DepthPicture(const cv::Mat& depth);

/// |model - live| as colours (turbo map, 0 = blue, 5 cm or more = red), HxW
/// 8UC3; black where either has no depth.
///
/// @param model_depth HxW 32FC1, metres, 0 = none.
/// @param live_depth the same size and type.
/// @throw InputError if types or sizes differ from that.
cv::Mat ErrorPicture(const cv::Mat& model_depth, const cv::Mat& live_depth);

/// Colour image with the surfaces (except the background) blended over it, half
/// and half, in their LabelColor and outlined in full colour, HxW 8UC3.
///
/// @param color HxW 8UC3.
/// @param labels HxW 16UC1 surface ids.
/// @throw InputError if types or sizes differ from that.
cv::Mat LabelPicture(const cv::Mat& color, const cv::Mat& labels);

/// Model colours on white: white where the model has no depth, HxW 8UC3.
///
/// @param model_color HxW 8UC3.
/// @param model_depth HxW 32FC1, metres, 0 = nothing.
/// @throw InputError if types or sizes differ from that.
cv::Mat CompositePicture(const cv::Mat& model_color,
                         const cv::Mat& model_depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_PICTURES_H_
