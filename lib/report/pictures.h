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

/// Depth as colours (turbo map, near = blue, far = red), HxW 8UC3; values
/// beyond the range take the colour of its end, pixels without depth are black.
///
/// @param depth HxW 32FC1, metres, 0 = none.
/// @param near_m, far_m range, metres.
/// @throw InputError if the type is another or far <= near.
cv::Mat DepthPicture(const cv::Mat& depth, float near_m = 0.4f,
                     float far_m = 5.0f);

/// |model - live| as colours (turbo map, 0 = blue, `max_error` or more = red),
/// HxW 8UC3; black where either has no depth.
///
/// @param model_depth HxW 32FC1, metres, 0 = none.
/// @param live_depth the same size and type.
/// @param max_error_m error of full red, metres.
/// @throw InputError if types or sizes differ from that, or max_error <= 0.
cv::Mat ErrorPicture(const cv::Mat& model_depth, const cv::Mat& live_depth,
                     float max_error_m = 0.05f);

/// Colour image with the surfaces (except the background) blended over it in
/// their LabelColor and outlined in full colour, HxW 8UC3.
///
/// @param color HxW 8UC3.
/// @param labels HxW 16UC1 surface ids.
/// @param opacity share of the label colour inside the outline, 0..1.
/// @throw InputError if types or sizes differ from that.
cv::Mat LabelPicture(const cv::Mat& color, const cv::Mat& labels,
                     double opacity = 0.5);

/// Model colours on white: white where the model has no depth, HxW 8UC3.
///
/// @param model_color HxW 8UC3.
/// @param model_depth HxW 32FC1, metres, 0 = nothing.
/// @throw InputError if types or sizes differ from that.
cv::Mat CompositePicture(const cv::Mat& model_color,
                         const cv::Mat& model_depth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_PICTURES_H_
