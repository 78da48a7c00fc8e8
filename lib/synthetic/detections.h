#ifndef SPLITFUSION_LIB_SYNTHETIC_DETECTIONS_H_
#define SPLITFUSION_LIB_SYNTHETIC_DETECTIONS_H_

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Faults of an imitated detector.
struct DetectorFaults {
  double miss_chance = 0.08;         ///< Of an instance in a frame.
  double wrong_class_chance = 0.02;  ///< Of a detection.
  double border_px = 3;      ///< Wobble of the border at 640 pixels of width.
  double min_area = 0.0012;  ///< Smaller instances are not found; part of the
                             ///< image.
};

/// No fault at all: every visible instance, exact to the pixel.
DetectorFaults ExactDetector();

/// Detections as a network would give them, best score first, out of an exact
/// label image (8UC1, pixel = instance id). `class_names`: class of each id;
/// ids that are not in it are not detected. The same seed gives the same masks.
std::vector<InstanceMask> ImitateDetections(
    const cv::Mat& labels, const std::map<int, std::string>& class_names,
    const DetectorFaults& faults, std::uint32_t seed);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_DETECTIONS_H_
