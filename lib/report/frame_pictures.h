#ifndef SPLITFUSION_LIB_REPORT_FRAME_PICTURES_H_
#define SPLITFUSION_LIB_REPORT_FRAME_PICTURES_H_

#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// Images of one frame that the pictures are made of; all of one size, in the
/// live camera. An empty image leaves out the pictures that need it.
struct FrameImages {
  cv::Mat color;          ///< Live, 8UC3 BGR.
  cv::Mat depth;          ///< Live, 32FC1, metres, 0 = none.
  cv::Mat labels;         ///< 16UC1 surface ids of the live pixels.
  cv::Mat model_color;    ///< All surfaces rendered, 8UC3 BGR.
  cv::Mat model_depth;    ///< All surfaces rendered, 32FC1, 0 = nothing.
  cv::Mat model_normals;  ///< All surfaces rendered, 32FC3, camera frame.
};

/// Writes RUN/pictures/FRAME_{input,labels,composite,normals,depth,error}.png
/// and FRAME_montage.png, which shows them side by side: the live colour, the
/// surfaces on it, the model in colour / its normals, its depth, and its
/// distance to the live depth (0 to 5 cm).
///
/// @throw InputError if an image has another type or size, or a file cannot be
///     written.
void WriteFramePictures(const RunPaths& paths, int frame,
                        const FrameImages& images);

/// Writes surface ids as 16-bit PNG RUN/masks/STEM.png.
///
/// @throw InputError if `labels` is not 16UC1 or the file cannot be written.
void WriteMask(const RunPaths& paths, const std::string& stem,
               const cv::Mat& labels);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_FRAME_PICTURES_H_
