#ifndef SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_
#define SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace splitfusion {

/// Mean of the pixels of a mask (not 0 inside), pixels; (0, 0) if it is empty.
cv::Point2d CenterOf(const cv::Mat& mask);

/// The part `to` of `image` moved by `shift` pixels, rounded; 0 where nothing
/// comes from.
template <typename T>
cv::Mat_<T> ShiftedPart(const cv::Mat_<T>& image, const cv::Point2d& shift,
                        const cv::Rect& to) {
  const cv::Mat_<double> motion =
      (cv::Mat_<double>(2, 3) << 1, 0, shift.x - to.x, 0, 1, shift.y - to.y);
  cv::Mat_<T> shifted;
  cv::warpAffine(image, shifted, motion, to.size(), cv::INTER_NEAREST);
  return shifted;
}

/// `image` moved by `shift` pixels, rounded; 0 where nothing comes from.
template <typename T>
cv::Mat_<T> Shifted(const cv::Mat_<T>& image, const cv::Point2d& shift) {
  return ShiftedPart(image, shift, cv::Rect({0, 0}, image.size()));
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_
