#ifndef SPLITFUSION_LIB_BASE_JSON_FILE_H_
#define SPLITFUSION_LIB_BASE_JSON_FILE_H_

#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/format_version.h"

namespace splitfusion {

/// Text of a JSON value. NaN and infinity become null, invalid UTF-8 becomes
/// the replacement character. `indent` < 0 gives one line.
template <typename Json>
std::string JsonText(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', /*ensure_ascii=*/false,
                    Json::error_handler_t::replace);
}

/// Writes JsonText() and the end of its last line through a temporary name.
///
/// @throw InputError if the file cannot be written.
template <typename Json>
void WriteJson(const std::string& path, const Json& value, int indent = -1) {
  WriteFileAtomically(
      path, [&](std::ostream& out) { out << JsonText(value, indent) << '\n'; });
}

/// The value in a file; null if the file is missing or broken.
template <typename Json = nlohmann::ordered_json>
Json ReadJsonOrNull(const std::string& path) {
  std::ifstream stream(path);
  Json value = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
  return value.is_discarded() ? Json() : value;
}

/// The same of a file that has a `format_version`, or had none yet.
///
/// @throw InputError if it is of a newer version than this program knows.
template <typename Json = nlohmann::ordered_json>
Json ReadVersionedOrNull(const std::string& path) {
  Json value = ReadJsonOrNull<Json>(path);
  CheckFormatVersion(path, value);
  return value;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_JSON_FILE_H_
