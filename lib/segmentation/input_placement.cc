#include "splitfusion/lib/segmentation/input_placement.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace splitfusion {
namespace {

cv::Mat Resized(const cv::Mat& image, cv::Size size) {
  if (image.size() == size) return image;
  cv::Mat resized;
  cv::resize(image, resized, size, 0, 0, cv::INTER_LINEAR);
  return resized;
}

/// Half of a margin as YOLOv8 rounds it: of an odd one the smaller part comes
/// first.
int HalfMargin(int margin) {
  return static_cast<int>(std::lround(margin / 2.0 - 0.1));
}

}  // namespace

cv::Rect2d InputPlacement::FrameBox(const cv::Rect2d& input_box) const {
  const double scale_x = static_cast<double>(frame.width) / content.width;
  const double scale_y = static_cast<double>(frame.height) / content.height;
  const cv::Rect2d box((input_box.x - content.x) * scale_x,
                       (input_box.y - content.y) * scale_y,
                       input_box.width * scale_x, input_box.height * scale_y);
  return box & cv::Rect2d(0, 0, frame.width, frame.height);
}

InputPlacement Letterbox(cv::Size frame, cv::Size input) {
  const double scale =
      std::min(static_cast<double>(input.width) / frame.width,
               static_cast<double>(input.height) / frame.height);
  const auto scaled = [scale](int length, int limit) {
    return std::clamp(static_cast<int>(std::lround(length * scale)), 1, limit);
  };
  const cv::Size size(scaled(frame.width, input.width),
                      scaled(frame.height, input.height));
  const cv::Point corner(HalfMargin(input.width - size.width),
                         HalfMargin(input.height - size.height));
  return {frame, input, {corner, size}};
}

InputPlacement Stretch(cv::Size frame, cv::Size input) {
  return {frame, input, {cv::Point(0, 0), input}};
}

cv::Mat PlaceFrame(const cv::Mat& color, const InputPlacement& placement,
                   const cv::Scalar& fill) {
  cv::Mat image(placement.input, color.type(), fill);
  Resized(color, placement.content.size()).copyTo(image(placement.content));
  return image;
}

cv::Mat FrameMask(const cv::Mat& probability, const InputPlacement& placement) {
  cv::Mat content = probability;
  if (placement.content.size() != placement.input) {
    content = Resized(probability, placement.input)(placement.content);
  }
  return Resized(content, placement.frame) > 0.5;
}

void ClearOutside(const cv::Rect2d& box, cv::Mat* mask) {
  const auto first = [](double edge) {  // Centre at or behind the edge.
    return static_cast<int>(std::ceil(edge - 0.5));
  };
  const cv::Point begin(first(box.x), first(box.y));
  const cv::Point end(first(box.x + box.width), first(box.y + box.height));
  const cv::Rect inside =
      cv::Rect(begin, end) & cv::Rect(cv::Point(0, 0), mask->size());
  cv::Mat cleared = cv::Mat::zeros(mask->size(), mask->type());
  if (!inside.empty()) (*mask)(inside).copyTo(cleared(inside));
  *mask = cleared;
}

}  // namespace splitfusion
