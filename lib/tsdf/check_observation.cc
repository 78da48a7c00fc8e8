#include "splitfusion/lib/tsdf/check_observation.h"

#include <string>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

std::string SizeText(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

void CheckSize(const cv::Mat& image, const std::string& name,
               const cv::Size& size) {
  if (image.size() == size) return;
  throw InputError("observation: " + name + " image is " +
                   SizeText(image.size()) + ": expected " + SizeText(size) +
                   ", the camera's size");
}

}  // namespace

void CheckObservation(const DepthObservation& observation,
                      const TsdfOptions& options) {
  const cv::Size size(observation.camera.width, observation.camera.height);
  observation.camera.Check();
  CheckSize(observation.depth, "depth", size);
  CheckSize(observation.weight, "weight", size);
  CheckSize(observation.role, "role", size);
  if (!observation.places.empty()) {
    CheckSize(observation.places, "places", size);
  }
  if (!options.has_color) return;
  CheckSize(observation.color, "color", size);
  if (observation.color.type() != CV_8UC3) {
    throw InputError("observation: color image is of type " +
                     std::to_string(observation.color.type()) +
                     ": expected 8UC3 (" + std::to_string(CV_8UC3) +
                     "), as the volume has colour");
  }
}

}  // namespace splitfusion
