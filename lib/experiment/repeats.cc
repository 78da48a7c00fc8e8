#include "splitfusion/lib/experiment/repeats.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/design.h"

namespace splitfusion {
namespace {

constexpr std::array<const char*, 2> kVoxels = {"object_voxel",
                                                "background_voxel"};
/// Of a shift, relative.
constexpr double kLeast = 1e-6, kMost = 9e-6;

double ShiftFactor(const std::string& key, int repeat) {
  const double share =
      StableUniform("repeat " + std::to_string(repeat) + " " + key);
  const double size = kLeast + (kMost - kLeast) * std::abs(2 * share - 1);
  return share < 0.5 ? 1 - size : 1 + size;
}

/// 0 if it is not there, or no number.
double NumberOfPart(const NamedValues& parts, const std::string& key) {
  const auto found = parts.find(key);
  return found == parts.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
}

}  // namespace

Settings ShiftVoxels(const NamedValues& parts, int repeat) {
  Settings settings;
  if (repeat == 0) return settings;
  for (const char* key : kVoxels) {
    const double size = NumberOfPart(parts, key);
    if (!(size > 0)) {
      throw InputError(std::string("--repeat: expected sf_run --print_identity "
                                   "to tell its ") +
                       key);
    }
    settings.Set(key, cv::format("%.12g", size * ShiftFactor(key, repeat)));
  }
  return settings;
}

std::string DifferencesBeyondRepeats(const NamedValues& before,
                                     const NamedValues& now) {
  NamedValues aligned = now;
  for (const char* key : kVoxels) {
    const double a = NumberOfPart(before, key), b = NumberOfPart(now, key);
    // Two repeats may be shifted in opposite directions.
    const bool shifted = a > 0 && std::abs(b / a - 1) < 2.5 * kMost;
    if (shifted) aligned[key] = before.at(key);
  }
  return Differences(before, aligned);
}

}  // namespace splitfusion
