#include "splitfusion/lib/sequence/sensors.h"

#include <utility>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Sensor = std::pair<std::string, DepthOptions>;

/// Range and noise: least, growth, best, reference.
const std::vector<Sensor>& Sensors() {
  static const std::vector<Sensor> sensors = {
      // Nguyen et al. 2012.
      {"kinect_v1", DepthOptions()},
      // Time of flight, narrow and not binned: range of the maker, whose bound
      // of 17 mm Toelgyessy et al. 2021 confirm; it grows slowly.
      {"kinect_azure", {0.5, 3.86, {0.001, 0.0005, 0.5, 2.5}}},
      // Stereo, D435 at 848 x 480: z^2 / (424 pixels x 50 mm) x 0.08 pixels.
      {"realsense", {0.28, 4.0, {0.001, 0.0038, 0.0, 0.725}}},
      // Rendered without noise.
      {"ideal", {0.2, 5.0, {0.0001, 0.0, 0.0, 5.0}}}};
  return sensors;
}

}  // namespace

std::vector<std::string> SensorNames() {
  std::vector<std::string> names;
  for (const auto& [name, options] : Sensors()) names.push_back(name);
  return names;
}

DepthOptions SensorOptions(const std::string& name) {
  for (const auto& [known, options] : Sensors()) {
    if (known == name) return options;
  }
  throw OptionError("sensor", name, AnyOf(SensorNames()));
}

}  // namespace splitfusion
