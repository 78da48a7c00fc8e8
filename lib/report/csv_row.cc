#include "splitfusion/lib/report/csv_row.h"

#include <cmath>

#include "splitfusion/lib/base/number_text.h"

namespace splitfusion {

CsvRow& CsvRow::Add(int value) { return Append(std::to_string(value)); }

CsvRow& CsvRow::Add(double value) {
  if (!std::isfinite(value)) return Append("");
  return Append(NumberText(value));
}

CsvRow& CsvRow::Add(const std::string& value) {
  if (value.find_first_of(",\"\r\n") == std::string::npos) return Append(value);
  std::string quoted = "\"";
  for (const char c : value) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return Append(quoted + "\"");
}

CsvRow& CsvRow::Append(const std::string& field) {
  if (!first_) text_ += ',';
  first_ = false;
  text_ += field;
  return *this;
}

}  // namespace splitfusion
