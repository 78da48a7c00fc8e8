#include "splitfusion/lib/tracking/dense_flow.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace splitfusion {
namespace {

/// The flow as it is seen from where it leads to.
cv::Mat_<cv::Vec2f> Advected(const cv::Mat_<cv::Vec2f>& flow) {
  cv::Mat_<cv::Vec2f> source(flow.size());
  for (int v = 0; v < flow.rows; ++v) {
    for (int u = 0; u < flow.cols; ++u) {
      source(v, u) =
          cv::Vec2f(static_cast<float>(u), static_cast<float>(v)) - flow(v, u);
    }
  }
  cv::Mat_<cv::Vec2f> advected;
  cv::remap(flow, advected, source, cv::noArray(), cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
  return advected;
}

/// `expected`: where the search begins; holds what was found in the end.
void Search(const cv::Mat& from, const cv::Mat& to,
            cv::Mat_<cv::Vec2f>* expected) {
  const auto search =
      cv::DISOpticalFlow::create(cv::DISOpticalFlow::PRESET_FAST);
  search->setFinestScale(0);
  search->calc(from, to, *expected);
}

std::optional<cv::Point2f> Sample(const cv::Mat_<cv::Vec2f>& flow,
                                  const cv::Point2f& pixel) {
  const int u = static_cast<int>(std::floor(pixel.x));
  const int v = static_cast<int>(std::floor(pixel.y));
  if (u < 0 || v < 0 || u + 1 >= flow.cols || v + 1 >= flow.rows) return {};
  const float a = pixel.x - static_cast<float>(u);
  const float b = pixel.y - static_cast<float>(v);
  const cv::Vec2f step =
      (1 - b) * ((1 - a) * flow(v, u) + a * flow(v, u + 1)) +
      b * ((1 - a) * flow(v + 1, u) + a * flow(v + 1, u + 1));
  return pixel + cv::Point2f(step);
}

}  // namespace

DenseFlow::DenseFlow(const cv::Mat_<std::uint8_t>& from,
                     const cv::Mat_<std::uint8_t>& to, const cv::Rect& box,
                     const cv::Mat_<cv::Vec2f>& before)
    : box_(box), forth_(Advected(before(box))) {
  // The search takes no part of an image as it lies in memory.
  const cv::Mat source = from(box).clone(), target = to(box).clone();
  Search(source, target, &forth_);
  back_ = -Advected(forth_);
  Search(target, source, &back_);
}

std::optional<cv::Point2f> DenseFlow::Follow(const cv::Point2f& pixel,
                                             double max_return) const {
  const cv::Point2f start = pixel - cv::Point2f(box_.tl());
  const auto end = Sample(forth_, start);
  if (!end) return {};
  const auto returned = Sample(back_, *end);
  if (!returned || cv::norm(*returned - start) > max_return) return {};
  return *end + cv::Point2f(box_.tl());
}

}  // namespace splitfusion
