#include "splitfusion/lib/split/image_motion.h"

namespace splitfusion {

cv::Point2d CenterOf(const cv::Mat& mask) {
  const cv::Moments moments = cv::moments(mask, /*binaryImage=*/true);
  if (moments.m00 <= 0) return {0, 0};
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

}  // namespace splitfusion
