#ifndef SPLITFUSION_LIB_SEGMENTATION_INPUT_PLACEMENT_H_
#define SPLITFUSION_LIB_SEGMENTATION_INPUT_PLACEMENT_H_

#include <opencv2/core.hpp>

namespace splitfusion {

/// Where a frame lies in the input image of a network. Coordinates are
/// continuous: pixel (i, j) covers [i, i + 1) x [j, j + 1), as boxes of
/// networks have it.
struct InputPlacement {
  cv::Size frame;    ///< Of the frame, pixels.
  cv::Size input;    ///< Of the network's input, pixels.
  cv::Rect content;  ///< Part of the input that holds the whole frame.

  /// A box of the input in the frame, clipped to it; empty if it lies outside.
  cv::Rect2d FrameBox(const cv::Rect2d& input_box) const;
};

/// The frame scaled as a whole to the largest size that fits, in the middle of
/// the input: the letterbox of YOLOv8.
InputPlacement Letterbox(cv::Size frame, cv::Size input);

/// The frame stretched over the whole input: the resizing of YOLACT.
InputPlacement Stretch(cv::Size frame, cv::Size input);

/// The input image: `color` scaled (bilinear) into the content of `placement`,
/// `fill` around it.
///
/// @param color 8UC3 of the placement's frame size.
cv::Mat PlaceFrame(const cv::Mat& color, const InputPlacement& placement,
                   const cv::Scalar& fill);

/// The mask of an instance in its frame, 8UC1, 255 where the probability,
/// interpolated (bilinear), is above 0.5.
///
/// @param probability 32FC1, covers the network's input at any resolution.
cv::Mat FrameMask(const cv::Mat& probability, const InputPlacement& placement);

/// Clears the pixels of a mask whose centre is outside of `box`.
void ClearOutside(const cv::Rect2d& box, cv::Mat* mask);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_INPUT_PLACEMENT_H_
