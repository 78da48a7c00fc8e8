#include "splitfusion/lib/experiment/outdated_runs.h"

#include <functional>
#include <map>
#include <vector>

#include "splitfusion/lib/experiment/repeats.h"

namespace splitfusion {
namespace {

/// Begins their status.
constexpr const char* kOutdated = "outdated: ";

/// Complete rows with something to compare, by what they have in common.
using RowGroups = std::map<std::string, std::vector<ResultRow*>>;

RowGroups Gather(ResultTable* table,
                 const std::function<std::string(const ResultRow&)>& key_of,
                 NamedValues ResultRow::*parts) {
  RowGroups groups;
  for (ResultRow& row : table->rows) {
    if (!row.IsComplete() || (row.*parts).empty()) continue;
    groups[key_of(row)].push_back(&row);
  }
  return groups;
}

/// The row that was looked at last: it is what its options ask for now.
const ResultRow& Newest(const std::vector<ResultRow*>& rows) {
  const ResultRow* newest = rows.front();
  for (const ResultRow* row : rows) {
    if (row->ended > newest->ended) newest = row;
  }
  return *newest;
}

/// Name of a task without its repeat.
std::string NameOfRepeats(const ResultRow& row) {
  return row.task.name.substr(0, row.task.name.rfind("_r"));
}

bool IsOutdated(const ResultRow& row) {
  return row.status.rfind(kOutdated, 0) == 0;
}

}  // namespace

void MarkOutdated(const std::string& why, ResultRow* row) {
  if (why.empty()) return;
  row->status = kOutdated + why;
  row->figures = Figures();
}

void MarkOutdated(ResultTable* table) {
  for (auto& [name, rows] : Gather(table, NameOfRepeats, &ResultRow::parts)) {
    const NamedValues now = Newest(rows).parts;
    for (ResultRow* row : rows) {
      MarkOutdated(DifferencesBeyondRepeats(row->parts, now), row);
    }
  }
  const auto sequence = [](const ResultRow& row) { return row.task.sequence; };
  for (auto& [name, rows] : Gather(table, sequence, &ResultRow::evaluated_by)) {
    const NamedValues now = Newest(rows).evaluated_by;
    for (ResultRow* row : rows) {
      MarkOutdated(Differences(row->evaluated_by, now), row);
    }
  }
}

std::string OutdatedText(const ResultTable& table) {
  int count = 0;
  const ResultRow* first = nullptr;
  for (const ResultRow& row : table.rows) {
    if (!IsOutdated(row)) continue;
    if (first == nullptr) first = &row;
    ++count;
  }
  if (first == nullptr) return "";
  return std::to_string(count) + " of " + std::to_string(table.rows.size()) +
         " runs are outdated and left out: " + first->task.name + " (" +
         first->status.substr(std::string(kOutdated).size()) +
         "); sf_batch run does them again";
}

}  // namespace splitfusion
