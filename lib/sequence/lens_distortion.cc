#include "splitfusion/lib/sequence/lens_distortion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/number_text.h"

namespace splitfusion {
namespace {

/// Half the diagonal of a pixel, squared: no place has its nearest pixel
/// farther away.
constexpr float kNearPixel = 0.5f;

/// Share of an undistorted image that has a pixel: a check of the coefficients.
constexpr double kLeastSeen = 0.25;  // Format.

/// Also false for what is not a number.
bool IsInside(const cv::Vec2f& place, const cv::Size& size) {
  return place[0] > -1 && place[1] > -1 &&
         place[0] < static_cast<float>(size.width) &&
         place[1] < static_cast<float>(size.height);
}

/// The nearest pixel of a place with a measurement, no farther than the nearest
/// of all may be; 0 if there is none.
float NearestMeasured(const cv::Mat_<float>& depth, const cv::Vec2f& place) {
  if (!IsInside(place, depth.size())) return 0;
  const int u0 = cvFloor(place[0]), v0 = cvFloor(place[1]);
  float best = 0, least = kNearPixel * 1.001f;  // For rounding.
  for (int v = std::max(v0, 0); v <= std::min(v0 + 1, depth.rows - 1); ++v) {
    for (int u = std::max(u0, 0); u <= std::min(u0 + 1, depth.cols - 1); ++u) {
      const float du = static_cast<float>(u) - place[0];
      const float dv = static_cast<float>(v) - place[1];
      const float distance = du * du + dv * dv;
      if (!(depth(v, u) > 0) || distance >= least) continue;
      least = distance;
      best = depth(v, u);
    }
  }
  return best;
}

}  // namespace

bool LensDistortion::IsNone() const {
  return std::all_of(coefficients.begin(), coefficients.end(),
                     [](double c) { return c == 0; });
}

cv::Point2d LensDistortion::Distorted(const cv::Point2d& point) const {
  const auto [k1, k2, p1, p2, k3, k4, k5, k6] = coefficients;
  const double x = point.x, y = point.y;
  const double r2 = x * x + y * y;
  const double s = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) /
                   (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return {s * x + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          s * y + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

std::string LensDistortion::Text() const {
  std::string text;
  for (const double c : coefficients) {
    text += (text.empty() ? "" : " ") + NumberText(c);
  }
  return text;
}

void LensDistortion::Check() const {
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    CheckOption(std::isfinite(coefficients[i]), kDistortionKeys[i],
                coefficients[i], "a finite number");
  }
}

Undistortion::Undistortion(const PinholeCamera& camera,
                           const LensDistortion& distortion)
    : places_(camera.height, camera.width) {
  std::size_t inside = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const cv::Point2d place = distortion.Distorted(
          {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
      places_(v, u) = {static_cast<float>(camera.fx * place.x + camera.cx),
                       static_cast<float>(camera.fy * place.y + camera.cy)};
      inside += IsInside(places_(v, u), places_.size());
    }
  }
  if (kLeastSeen * static_cast<double>(places_.total()) <=
      static_cast<double>(inside)) {
    return;
  }
  throw InputError("lens " + distortion.Text() + ": " + std::to_string(inside) +
                   " of " + std::to_string(places_.total()) +
                   " pixels were seen through it: expected a quarter or more");
}

cv::Mat Undistortion::Color(const cv::Mat& image) const {
  cv::Mat result;
  cv::remap(image, result, places_, cv::Mat(), cv::INTER_LINEAR,
            cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return result;
}

cv::Mat_<float> Undistortion::Depth(const cv::Mat_<float>& depth) const {
  cv::Mat_<float> result(depth.size());
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      result(v, u) = NearestMeasured(depth, places_(v, u));
    }
  }
  return result;
}

cv::Mat Undistortion::Mask(const cv::Mat& mask) const {
  cv::Mat result;
  cv::remap(mask, result, places_, cv::Mat(), cv::INTER_NEAREST,
            cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return result;
}

}  // namespace splitfusion
