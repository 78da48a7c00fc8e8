#ifndef SPLITFUSION_LIB_SEQUENCE_SENSORS_H_
#define SPLITFUSION_LIB_SEQUENCE_SENSORS_H_

#include <string>
#include <vector>

#include "splitfusion/lib/sequence/depth_filter.h"

namespace splitfusion {

/// Names of the depth sensors whose noise and range are known.
std::vector<std::string> SensorNames();

/// What is known of a depth sensor; sources in docs/your_data.md. A measurement
/// has its full weight up to the depth at which its noise is 3 mm.
///
/// @throw OptionError if `name` is none of SensorNames().
DepthOptions SensorOptions(const std::string& name);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_SENSORS_H_
