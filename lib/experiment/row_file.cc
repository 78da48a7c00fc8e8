#include "splitfusion/lib/experiment/row_file.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/csv_row.h"

namespace splitfusion {
namespace {

constexpr std::size_t kTextColumns = 6;
constexpr std::size_t kColumns = kTextColumns + kFigureNames.size();

std::string HeadLine() {
  CsvRow row;
  for (const char* name :
       {"identity", "task", "sequence", "row", "settings", "seconds"}) {
    row.Add(std::string(name));
  }
  for (const char* name : kFigureNames) row.Add(std::string(name));
  return row.text();
}

/// Fields of one line (RFC 4180); fields here hold no line break.
std::vector<std::string> Fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += '"';
      ++i;
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

/// NaN for an empty field.
double ReadNumber(const std::string& text) {
  return text.empty() ? std::numeric_limits<double>::quiet_NaN()
                      : std::strtod(text.c_str(), nullptr);
}

Figures ReadFigures(const std::vector<std::string>& fields) {
  Figures figures;
  for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
    figures.values[i] = ReadNumber(fields[kTextColumns + i]);
  }
  return figures;
}

}  // namespace

std::string RowKey(const std::string& identity, const NamedValues& evaluation) {
  if (evaluation.empty()) return identity;
  ContentHash hash;
  hash.Add(identity);
  for (const auto& [name, value] : evaluation) hash.Add(name).Add(value);
  return hash.Hex();
}

RowFile::RowFile(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw InputError(path + ": is a folder: expected a file of rows");
  }
  std::ifstream stream(path);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::vector<std::string> fields = Fields(line);
    const bool good = number == 1
                          ? line == HeadLine()
                          : fields.size() == kColumns && !fields[0].empty();
    if (!good) {
      throw InputError(path + ", line " + std::to_string(number) +
                       ": expected a row that sf_batch writes");
    }
    if (number == 1) continue;
    Set(fields[0], {fields[1], fields[2], fields[3], fields[4],
                    ReadNumber(fields[5]), ReadFigures(fields)});
  }
}

const RowFile::Row* RowFile::Find(const std::string& key,
                                  const std::string& sequence) const {
  const auto found = rows_.find({key, sequence});
  return found == rows_.end() ? nullptr : &found->second;
}

void RowFile::Set(const std::string& key, const Row& row) {
  rows_[{key, row.sequence}] = row;
}

void RowFile::Write(const std::string& path) const {
  std::map<std::pair<std::string, std::string>, const Row*> order;
  for (const auto& [key, row] : rows_) order[{row.task, key.first}] = &row;
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << HeadLine() << '\n';
    for (const auto& [key, known] : order) {
      const Row& row = *known;
      CsvRow line;
      line.Add(key.second).Add(row.task).Add(row.sequence).Add(row.row);
      line.Add(row.settings).Add(row.seconds);
      for (const double value : row.figures.values) line.Add(value);
      out << line.text() << '\n';
    }
  });
}

}  // namespace splitfusion
