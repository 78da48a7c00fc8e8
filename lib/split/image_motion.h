#ifndef SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_
#define SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace splitfusion {

/// Mean of the pixels of a mask (not 0 inside), pixels; (0, 0) if it is empty.
cv::Point2d CenterOf(const cv::Mat& mask);

/// `image` moved by `shift` pixels, rounded; 0 where nothing comes from.
template <typename T>
cv::Mat_<T> Shifted(const cv::Mat_<T>& image, const cv::Point2d& shift) {
  const cv::Mat_<double> motion =
      (cv::Mat_<double>(2, 3) << 1, 0, shift.x, 0, 1, shift.y);
  cv::Mat_<T> shifted;
  cv::warpAffine(image, shifted, motion, image.size(), cv::INTER_NEAREST);
  return shifted;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_IMAGE_MOTION_H_
