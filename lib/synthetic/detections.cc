#include "splitfusion/lib/synthetic/detections.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/synthetic/hash_noise.h"
#include "splitfusion/lib/synthetic/kinect_noise.h"

namespace splitfusion {
namespace {

const char* const kWrongClasses[] = {"kite", "chair", "umbrella", "dog"};

/// Moves the mask's border in and out by a smooth random displacement.
cv::Mat WobbleMask(const cv::Mat& mask, double border_px, std::uint32_t seed) {
  const double scale = mask.cols / 640.0;
  const double amplitude = border_px * scale;
  if (amplitude <= 0) return mask.clone();
  const double waviness = 7 * scale;
  const cv::Mat_<float> dx = CorrelatedNoise(mask.size(), waviness, seed);
  const cv::Mat_<float> dy = CorrelatedNoise(mask.size(), waviness, seed + 1);
  cv::Mat_<cv::Vec2f> map(mask.size());
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      map(v, u) = cv::Vec2f(static_cast<float>(u + amplitude * dx(v, u)),
                            static_cast<float>(v + amplitude * dy(v, u)));
    }
  }
  cv::Mat wobbly;
  cv::remap(mask, wobbly, map, cv::noArray(), cv::INTER_NEAREST,
            cv::BORDER_REPLICATE);
  return wobbly;
}

}  // namespace

DetectorFaults ExactDetector() { return {0, 0, 0, 0}; }

std::vector<InstanceMask> ImitateDetections(
    const cv::Mat& labels, const std::map<int, std::string>& class_names,
    const DetectorFaults& faults, std::uint32_t seed) {
  std::vector<InstanceMask> detections;
  for (const auto& [id, name] : class_names) {
    const auto chance = [&, id = id](int stream) {
      return HashUnit(id, stream, 0, seed);
    };
    const cv::Mat exact = labels == id;
    const int area = cv::countNonZero(exact);
    if (area == 0 || area < faults.min_area * labels.total() ||
        chance(0) < faults.miss_chance) {
      continue;
    }
    InstanceMask detection;
    detection.mask =
        WobbleMask(exact, faults.border_px, HashCell(id, 1, 0, seed));
    const bool wrong = chance(2) < faults.wrong_class_chance;
    detection.class_name =
        wrong ? kWrongClasses[HashCell(id, 3, 0, seed) % 4] : name;
    detection.score = 0.99 - 0.3 * chance(4) - (wrong ? 0.25 : 0.0);
    if (cv::countNonZero(detection.mask) > 0) detections.push_back(detection);
  }
  std::stable_sort(detections.begin(), detections.end(),
                   [](const InstanceMask& a, const InstanceMask& b) {
                     return a.score > b.score;
                   });
  return detections;
}

}  // namespace splitfusion
