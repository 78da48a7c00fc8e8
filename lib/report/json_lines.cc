#include "splitfusion/lib/report/json_lines.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

std::vector<nlohmann::ordered_json> ReadJsonLines(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::vector<nlohmann::ordered_json> lines;
  std::string text;
  while (std::getline(stream, text) && !stream.eof()) {
    lines.push_back(nlohmann::ordered_json::parse(text, nullptr,
                                                  /*allow_exceptions=*/false));
    if (!lines.back().is_object()) {
      throw InputError(path + ":" + std::to_string(lines.size()) +
                       ": expected a JSON object, found '" +
                       text.substr(0, 60) + "'");
    }
  }
  return lines;
}

}  // namespace splitfusion
