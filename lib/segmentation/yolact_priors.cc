#include "splitfusion/lib/segmentation/yolact_priors.h"

#include <cmath>

namespace splitfusion {
namespace {

constexpr double kBaseInput = 550;  // The scales are for this input.
constexpr double kScales[] = {24, 48, 96, 192, 384};
constexpr double kAspectRatios[] = {1, 0.5, 2};
constexpr int kFirstStride = 8;

/// Scale of a level in pixels; whole pixels, as the configurations of other
/// input sizes have it.
double ScaleAt(double base_scale, int input) {
  return std::floor(base_scale * input / kBaseInput + 1e-9);
}

}  // namespace

std::vector<CenterBox> YolactPriors(int input) {
  std::vector<CenterBox> priors;
  int cells = (input + kFirstStride - 1) / kFirstStride;
  for (const double base_scale : kScales) {
    const double scale = ScaleAt(base_scale, input);
    for (int cell = 0; cell < cells * cells; ++cell) {
      const auto cx = static_cast<float>((cell % cells + 0.5) / cells);
      const auto cy = static_cast<float>((cell / cells + 0.5) / cells);
      for (const double ratio : kAspectRatios) {
        const auto w = static_cast<float>(scale * std::sqrt(ratio) / input);
        priors.push_back({cx, cy, w, w});
      }
    }
    cells = (cells + 1) / 2;
  }
  return priors;
}

cv::Rect2f DecodeYolactBox(const CenterBox& prior, const float* location) {
  const float cx = prior.cx + 0.1f * location[0] * prior.w;
  const float cy = prior.cy + 0.1f * location[1] * prior.h;
  const float w = prior.w * std::exp(0.2f * location[2]);
  const float h = prior.h * std::exp(0.2f * location[3]);
  return {cx - w / 2, cy - h / 2, w, h};
}

}  // namespace splitfusion
