#ifndef SPLITFUSION_LIB_BASE_BRIEF_JSON_H_
#define SPLITFUSION_LIB_BASE_BRIEF_JSON_H_

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace splitfusion {

/// JSON of others for a message of one line: not deeper than `levels`, about
/// 200 characters at most, "..." for the rest. The library's dump() calls
/// itself as deep as the value is, which may be too deep for the stack.
template <typename Json>
std::string BriefJson(const Json& value, int levels = 3) {
  constexpr std::size_t kMaxBytes = 200;
  if (!value.is_structured()) {
    const std::string text =
        value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() <= kMaxBytes ? text : text.substr(0, kMaxBytes) + "...";
  }
  std::string text = value.is_array() ? "[" : "{";
  for (auto item = value.begin(); item != value.end(); ++item) {
    if (text.size() > 1) text += ",";
    if (levels == 0 || text.size() > kMaxBytes) {
      text += "...";
      break;
    }
    if (value.is_object()) text += BriefJson(Json(item.key())) + ":";
    text += BriefJson(*item, levels - 1);
  }
  return text + (value.is_array() ? "]" : "}");
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_BRIEF_JSON_H_
