#ifndef SPLITFUSION_LIB_REPORT_CSV_ROW_H_
#define SPLITFUSION_LIB_REPORT_CSV_ROW_H_

#include <string>

namespace splitfusion {

/// Builds one line of a CSV file, field by field.
class CsvRow {
 public:
  /// Decimal digits.
  CsvRow& Add(int value);
  /// Shortest text that reads back exactly; empty for NaN and infinity.
  CsvRow& Add(double value);
  /// Quoted where it holds a comma, a quote or a line break (RFC 4180).
  CsvRow& Add(const std::string& value);

  /// The line without its end.
  const std::string& text() const { return text_; }

 private:
  CsvRow& Append(const std::string& field);

  std::string text_;
  bool first_ = true;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_CSV_ROW_H_
