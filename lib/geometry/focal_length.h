#ifndef SPLITFUSION_LIB_GEOMETRY_FOCAL_LENGTH_H_
#define SPLITFUSION_LIB_GEOMETRY_FOCAL_LENGTH_H_

#include <string>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

/// Longest focal length, pixels: 0.4 degrees are 640 of them.
inline constexpr double kLongestFocalLength = 1e5;

/// @throw InputError unless `f` may be a focal length, pixels; `field` names
/// it.
inline void CheckFocalLength(const std::string& field, double f) {
  CheckOption(f > 0 && f <= kLongestFocalLength, field, f,
              "a focal length > 0, 100000 pixels at most");
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_FOCAL_LENGTH_H_
