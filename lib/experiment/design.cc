#include "splitfusion/lib/experiment/design.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/mixed_bits.h"

namespace splitfusion {
namespace {

/// Numbers between two ends.
struct Range {
  double low = 0;
  double high = 0;
  bool logarithmic = false;
  bool whole = false;  ///< Both ends are whole numbers.
};

std::optional<double> Number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool whole_text = !text.empty() && *end == '\0';
  return whole_text && std::isfinite(value) ? std::optional(value)
                                            : std::nullopt;
}

bool IsWhole(const std::string& text) {
  return text.find_first_not_of("+-0123456789") == std::string::npos;
}

/// Empty if the text is a plain value.
std::optional<Range> ReadRange(const std::string& value) {
  const bool logarithmic = value.rfind("log:", 0) == 0;
  const std::string ends = logarithmic ? value.substr(4) : value;
  const std::size_t dots = ends.find("..");
  if (dots == std::string::npos) return std::nullopt;
  const std::string low_text = ends.substr(0, dots);
  const std::string high_text = ends.substr(dots + 2);
  const auto low = Number(low_text), high = Number(high_text);
  if (!low || !high) return std::nullopt;
  return Range{*low, *high, logarithmic, IsWhole(low_text + high_text)};
}

void CheckRange(const Range& range, const std::string& value) {
  CheckOption(range.low < range.high && (!range.logarithmic || range.low > 0),
              "grid", value,
              "lo..hi or log:lo..hi with lo < hi, lo > 0 for log");
}

std::string Draw(const Range& range, double share) {
  if (range.logarithmic) {
    const double value = range.low * std::pow(range.high / range.low, share);
    return range.whole ? cv::format("%.0f", value) : cv::format("%.4g", value);
  }
  if (!range.whole) {
    return cv::format("%.4g", range.low + share * (range.high - range.low));
  }
  const double count = range.high - range.low + 1;
  return cv::format("%.0f", range.low + std::floor(share * count));
}

std::string Draw(const Axis& axis, double share) {
  const std::size_t index =
      static_cast<std::size_t>(share * static_cast<double>(axis.values.size()));
  const std::string& value = axis.values[index];
  const auto range = ReadRange(value);
  if (!range) return value;
  CheckRange(*range, value);
  // With several ranges the place within one must not tell which it is.
  const double place = share * static_cast<double>(axis.values.size());
  return Draw(*range, place - std::floor(place));
}

}  // namespace

std::vector<Settings> ExpandGrid(const std::vector<Axis>& axes) {
  std::vector<Settings> points(1);
  for (const Axis& axis : axes) {
    std::vector<Settings> longer;
    for (const Settings& point : points) {
      for (const std::string& value : axis.values) {
        CheckOption(!ReadRange(value), "grid", axis.key + "=" + value,
                    "values; a range needs --random=N");
        longer.push_back(point);
        longer.back().Set(axis.key, value);
      }
    }
    points = std::move(longer);
  }
  return points;
}

std::vector<Settings> DrawDesign(const std::vector<Axis>& axes, int count,
                                 std::uint64_t seed) {
  CheckOption(!axes.empty(), "random", count,
              "keys with ranges or values in --grid");
  std::vector<Settings> points(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    for (const Axis& axis : axes) {
      const double share = StableUniform(std::to_string(seed) + "/" +
                                         std::to_string(i) + "/" + axis.key);
      points[static_cast<std::size_t>(i)].Set(axis.key, Draw(axis, share));
    }
  }
  return points;
}

std::uint64_t StableHash(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a.
  for (const unsigned char c : text) hash = (hash ^ c) * 0x100000001b3ULL;
  return MixedBits(hash);
}

double StableUniform(const std::string& text) {
  return std::ldexp(static_cast<double>(StableHash(text) >> 11), -53);
}

}  // namespace splitfusion
