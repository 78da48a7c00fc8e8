#ifndef SPLITFUSION_LIB_BASE_FORMAT_VERSION_H_
#define SPLITFUSION_LIB_BASE_FORMAT_VERSION_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "splitfusion/lib/base/brief_json.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {

/// `format_version` of all JSON files that the programs write. It grows when a
/// key that a reader may ask for goes or changes its meaning, not when one is
/// added. Files without it are older, and are read.
constexpr int kFormatVersion = 1;  // Format.

/// The object with `format_version` as its first field.
template <typename Json>
Json Versioned(const Json& object) {
  Json versioned = {{"format_version", kFormatVersion}};
  versioned.update(object);
  return versioned;
}

/// @throw InputError if an object says that it is of a newer version, or of
///     none that there can be. `place`: the file.
template <typename Json>
void CheckFormatVersion(const std::string& place, const Json& json) {
  const auto found = json.find("format_version");
  if (found == json.end()) return;
  if (found->is_number_integer()) {
    const auto version = found->template get<std::int64_t>();
    if (0 <= version && version <= kFormatVersion) return;
  }
  throw InputError(place + ": field 'format_version': " + BriefJson(*found) +
                   ": expected at most " + std::to_string(kFormatVersion) +
                   "; a file of a newer version needs its programs");
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_FORMAT_VERSION_H_
