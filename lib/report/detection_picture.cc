#include "splitfusion/lib/report/detection_picture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/pictures.h"

namespace splitfusion {
namespace {

constexpr double kMaskOpacity = 0.45;

void CheckSizes(const cv::Mat& color,
                const std::vector<InstanceMask>& instances) {
  for (const InstanceMask& instance : instances) {
    if (instance.mask.size() == color.size()) continue;
    throw InputError("picture: mask of " + std::to_string(instance.mask.cols) +
                     "x" + std::to_string(instance.mask.rows) + "; expected " +
                     std::to_string(color.cols) + "x" +
                     std::to_string(color.rows));
  }
}

void PaintMask(const cv::Mat& mask, const cv::Scalar& paint, cv::Mat* picture) {
  cv::Mat blended;
  cv::addWeighted(*picture, 1 - kMaskOpacity,
                  cv::Mat(picture->size(), CV_8UC3, paint), kMaskOpacity, 0,
                  blended);
  blended.copyTo(*picture, mask);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::drawContours(*picture, outlines, -1, paint);
}

/// Class and score inside the upper left corner of the box, moved so that they
/// stay in the picture.
void DrawCaption(const InstanceMask& instance, cv::Point corner,
                 cv::Mat* picture) {
  constexpr double kScale = 0.42;
  const std::string text =
      instance.class_name + cv::format(" %.2f", instance.score);
  const int width =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 1, nullptr).width;
  const cv::Point place(
      std::max(std::min(corner.x, picture->cols - width - 4) + 2, 2),
      std::max(corner.y + 12, 12));
  for (const auto& [paint, thickness] :
       {std::pair(cv::Scalar::all(0), 3), std::pair(cv::Scalar::all(255), 1)}) {
    cv::putText(*picture, text, place, cv::FONT_HERSHEY_SIMPLEX, kScale, paint,
                thickness, cv::LINE_AA);
  }
}

}  // namespace

cv::Mat DetectionPicture(const cv::Mat& color,
                         const std::vector<InstanceMask>& instances) {
  CheckSizes(color, instances);
  cv::Mat picture = color.clone();
  for (std::size_t i = instances.size(); i-- > 0;) {
    PaintMask(instances[i].mask, LabelColor(static_cast<int>(i + 1)), &picture);
  }
  for (std::size_t i = instances.size(); i-- > 0;) {
    const InstanceMask& instance = instances[i];
    const cv::Rect box = instance.box.empty() ? cv::boundingRect(instance.mask)
                                              : cv::Rect(instance.box);
    cv::rectangle(picture, box, LabelColor(static_cast<int>(i + 1)));
    DrawCaption(instance, box.tl(), &picture);
  }
  return picture;
}

}  // namespace splitfusion
