#include "splitfusion/lib/report/detection_picture.h"

#include <algorithm>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/pictures.h"

namespace splitfusion {
namespace {

constexpr double kOpacity = 0.45;

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
  cv::addWeighted(*picture, 1 - kOpacity,
                  cv::Mat(picture->size(), CV_8UC3, paint), kOpacity, 0,
                  blended);
  blended.copyTo(*picture, mask);
  std::vector<std::vector<cv::Point>> outlines;
  cv::findContours(mask, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_NONE);
  cv::drawContours(*picture, outlines, -1, paint);
}

void DrawCaption(const InstanceMask& instance, cv::Point corner,
                 cv::Mat* picture) {
  char score[16];
  std::snprintf(score, sizeof(score), " %.2f", instance.score);
  const cv::Point place(std::max(corner.x + 2, 2), std::max(corner.y + 12, 12));
  for (const auto& [paint, width] :
       {std::pair(cv::Scalar::all(0), 3), std::pair(cv::Scalar::all(255), 1)}) {
    cv::putText(*picture, instance.class_name + score, place,
                cv::FONT_HERSHEY_SIMPLEX, 0.42, paint, width, cv::LINE_AA);
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
