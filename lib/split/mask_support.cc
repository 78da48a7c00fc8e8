#include "splitfusion/lib/split/mask_support.h"

#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/split/image_motion.h"

namespace splitfusion {
namespace {

constexpr double kNewest = 0.25;  // Weight of the newest detection.
constexpr float kUnknown = 0.5f;  // Support before the first detection.
constexpr int kReach = 7;         // Pixels over which the support is spread.

/// Where pixels moved by `shift`, and what they are spread over, may be.
cv::Rect ReachOf(const cv::Mat_<uchar>& pixels, const cv::Point2d& shift) {
  cv::Rect box = cv::boundingRect(pixels);
  constexpr int kMargin = kReach + 2;  // Rounding included.
  box += cv::Point(cvFloor(shift.x) - kMargin, cvFloor(shift.y) - kMargin);
  box += cv::Size(2 * kMargin, 2 * kMargin);
  return box & cv::Rect({0, 0}, pixels.size());
}

}  // namespace

cv::Mat_<float> MaskSupport::Predict(int surface,
                                     const LabelImage& predicted_labels) const {
  cv::Mat_<float> result(predicted_labels.size(), kUnknown);
  const auto found = states_.find(surface);
  const cv::Mat predicted = predicted_labels == surface;
  if (found == states_.end() || cv::countNonZero(predicted) == 0) {
    return result;
  }
  const State& state = found->second;
  const cv::Point2d shift = CenterOf(predicted) - CenterOf(state.pixels);
  const cv::Rect to = ReachOf(state.pixels, shift);
  if (to.area() == 0) return result;
  cv::Mat_<float> inside;
  state.pixels.convertTo(inside, CV_32F, 1.0 / 255);
  inside = ShiftedPart(inside, shift, to);
  cv::Mat_<float> support = ShiftedPart(state.support, shift, to);
  const cv::Size window(2 * kReach + 1, 2 * kReach + 1);
  cv::blur(inside, inside, window);
  cv::blur(support, support, window);
  for (int v = 0; v < to.height; ++v) {
    for (int u = 0; u < to.width; ++u) {
      if (inside(v, u) > 0.01f) {  // Maths.
        result(to.y + v, to.x + u) = support(v, u) / inside(v, u);
      }
    }
  }
  return result;
}

void MaskSupport::Update(int surface, const cv::Mat_<uchar>& pixels,
                         const cv::Mat_<uchar>& mask,
                         const LabelImage& predicted_labels) {
  cv::Mat_<float> covered;
  mask.convertTo(covered, CV_32F, 1.0 / 255);
  if (states_.count(surface) > 0) {
    covered =
        (1 - kNewest) * Predict(surface, predicted_labels) + kNewest * covered;
  }
  covered.setTo(0, ~pixels);
  states_[surface] = {pixels.clone(), covered};
}

}  // namespace splitfusion
