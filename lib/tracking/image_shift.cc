#include "splitfusion/lib/tracking/image_shift.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr int kColumns = 80;  // Of the grid that is searched.
/// Farther from or nearer to the camera by more, metres, a surface would look
/// larger or smaller.
constexpr float kMaxDepthChange = 0.4f;
constexpr double kMinExplained = 0.3;
/// Of the live points, as much as a pixel of way counts.
constexpr double kWayCost = 0.002;

/// Every step-th pixel of every step-th row.
cv::Mat Coarse(const cv::Mat& image, int step) {
  cv::Mat coarse;
  const cv::Size size((image.cols + step - 1) / step,
                      (image.rows + step - 1) / step);
  const cv::Matx23d shrink(step, 0, 0, 0, step, 0);
  cv::warpAffine(image, coarse, shrink, size,
                 cv::INTER_NEAREST | cv::WARP_INVERSE_MAP);
  return coarse;
}

/// Median of the values at the pixels of `mask`, of which there are some.
float Median(const cv::Mat_<float>& values, const cv::Mat_<uchar>& mask) {
  std::vector<float> chosen;
  for (int v = 0; v < values.rows; ++v) {
    for (int u = 0; u < values.cols; ++u) {
      if (mask(v, u)) chosen.push_back(values(v, u));
    }
  }
  const auto middle = chosen.begin() + chosen.size() / 2;
  std::nth_element(chosen.begin(), middle, chosen.end());
  return *middle;
}

/// For every shift the sum of `values` at the pixels that `mask`, shifted,
/// covers; entry (mask.rows + dv, mask.cols + du). Whole numbers and halves.
cv::Mat_<float> SumUnder(const cv::Mat& mask, const cv::Mat& values) {
  cv::Mat bordered, sums;
  cv::copyMakeBorder(values, bordered, mask.rows, mask.rows, mask.cols,
                     mask.cols, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::matchTemplate(bordered, mask, sums, cv::TM_CCORR);
  // Without the rounding errors of the Fourier transform.
  for (float& sum : cv::Mat_<float>(sums)) sum = std::round(2 * sum) / 2;
  return sums;
}

/// The shift with the greatest sum, less `cost` for every pixel of its way: a
/// model that is smaller than what is seen fits in many places.
cv::Point BestShift(const cv::Mat_<float>& sums, const cv::Point& none,
                    double cost) {
  cv::Point best = none;
  double best_worth = sums(none);
  for (int v = 0; v < sums.rows; ++v) {
    for (int u = 0; u < sums.cols; ++u) {
      const double worth =
          sums(v, u) - cost * (std::abs(u - none.x) + std::abs(v - none.y));
      if (worth <= best_worth) continue;
      best_worth = worth;
      best = {u, v};
    }
  }
  return best - none;
}

/// `image` moved by `shift` pixels, 0 where nothing comes from.
cv::Mat_<float> Shifted(const cv::Mat_<float>& image, const cv::Point& shift) {
  cv::Mat moved;
  const cv::Matx23d way(1, 0, shift.x, 0, 1, shift.y);
  cv::warpAffine(image, moved, way, image.size(), cv::INTER_NEAREST);
  return moved;
}

}  // namespace

std::optional<Rigid3d> FindImageShift(const cv::Mat_<float>& model,
                                      const LiveView& live,
                                      std::uint16_t surface) {
  const int stride = std::max(1, live.depth.cols / std::max(1, model.cols));
  const int model_step = std::max(1, live.depth.cols / kColumns / stride);
  const int step = model_step * stride;  // Live pixels between candidates.
  const cv::Mat_<float> coarse = Coarse(model, model_step);
  const cv::Mat_<float> seen = Coarse(live.depth, step);
  const cv::Mat_<uchar> own =
      (Coarse(live.labels, step) == surface) & (seen > 0);
  const int visible = cv::countNonZero(coarse > 0);
  if (cv::countNonZero(own) == 0 || visible == 0) return std::nullopt;
  const float z = Median(seen, own);

  // A live point of the surface that the model explains counts for a shift;
  // what is seen behind the surface and the model would hide, half against it.
  cv::Mat_<float> worth(seen.size(), 0.0f), mask(coarse.size(), 0.0f);
  worth.setTo(-0.5f, seen > z + kOneBody.At(z));
  worth.setTo(1.0f, own);
  mask.setTo(1.0f, coarse > 0);
  const cv::Point shift =
      BestShift(SumUnder(mask, worth), {mask.cols, mask.rows},
                kWayCost * cv::countNonZero(own));

  const cv::Mat_<float> moved = Shifted(coarse, shift);
  const cv::Mat_<uchar> both = own & (moved > 0);
  if (cv::countNonZero(both) == 0) return std::nullopt;
  const cv::Mat_<float> change = seen - moved;
  const float depth_change = Median(change, both);
  const int explained = cv::countNonZero(
      both & (cv::abs(change - depth_change) < kOneBody.At(z)));
  if (std::abs(depth_change) > kMaxDepthChange ||
      explained < kMinExplained * std::min(cv::countNonZero(own), visible)) {
    return std::nullopt;
  }
  Rigid3d motion = Rigid3d::Identity();
  motion.translation() =
      Eigen::Vector3d(shift.x * step * z / live.camera.fx,
                      shift.y * step * z / live.camera.fy, depth_change);
  return motion;
}

}  // namespace splitfusion
