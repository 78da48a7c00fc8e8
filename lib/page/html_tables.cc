#include "splitfusion/lib/page/html_tables.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/page/html_page.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// A number as people read it: four digits, whole ones as they are.
std::string Rounded(double value) {
  if (std::abs(value) < 1e15 && value == std::floor(value)) {
    return cv::format("%.0f", value);
  }
  return cv::format("%.4g", value);
}

std::string TextOf(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_number()) return Rounded(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return JsonText(value);
  std::string text;
  for (const Json& item : value) {
    text += (text.empty() ? "" : ", ") + TextOf(item);
  }
  return text;
}

std::string Cell(const Json& value) {
  return (value.is_number() ? "<td class=\"n\">" : "<td>") +
         HtmlEscaped(TextOf(value)) + "</td>";
}

}  // namespace

std::string Heading(const std::string& text) {
  return "<h3>" + HtmlEscaped(text) + "</h3>\n";
}

std::string KeyTable(const Json& object) {
  std::string html = "<div class=\"wide\"><table>\n";
  for (const auto& [key, value] : object.items()) {
    html += "<tr><th>" + HtmlEscaped(key) + "</th>" + Cell(value) + "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string RowTable(const Json& rows) {
  if (rows.empty()) return "<p>none</p>\n";
  std::vector<std::string> keys;
  for (const Json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
        keys.push_back(key);
      }
    }
  }
  std::string html = "<div class=\"wide\"><table class=\"rows\">\n<tr>";
  for (const std::string& key : keys) {
    html += "<th>" + HtmlEscaped(key) + "</th>";
  }
  for (const Json& row : rows) {
    html += "</tr>\n<tr>";
    for (const std::string& key : keys) html += Cell(row.value(key, Json()));
  }
  return html + "</tr>\n</table></div>\n";
}

std::string Details(const std::string& title, const std::string& content) {
  return "<details><summary>" + HtmlEscaped(title) + "</summary>\n" + content +
         "</details>\n";
}

}  // namespace splitfusion
