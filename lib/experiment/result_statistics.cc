#include "splitfusion/lib/experiment/result_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
using FigureValues = std::array<std::vector<double>, kFigureNames.size()>;

/// Rows of one group, as they come.
struct Gathered {
  ResultGroup group;
  FigureValues values;
  std::vector<double> seconds;
};

/// Groups in the order in which they are first met.
class Groups {
 public:
  Gathered& At(const std::string& sequence,
               const std::vector<std::string>& values) {
    const auto key = std::pair(sequence, values);
    const auto [found, is_new] = places_.emplace(key, groups_.size());
    if (is_new) {
      groups_.emplace_back();
      groups_.back().group.sequence = sequence;
      groups_.back().group.values = values;
    }
    return groups_[found->second];
  }

  std::vector<ResultGroup> Describe() {
    std::vector<ResultGroup> described;
    for (Gathered& gathered : groups_) {
      for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
        gathered.group.figures[i] = DescribeValues(gathered.values[i]);
      }
      gathered.group.seconds = DescribeValues(gathered.seconds);
      described.push_back(gathered.group);
    }
    return described;
  }

 private:
  std::map<std::pair<std::string, std::vector<std::string>>, std::size_t>
      places_;
  std::vector<Gathered> groups_;
};

/// What the baseline is, by keys that vary.
Settings ReadBaseline(const ResultTable& table, const std::string& baseline) {
  Settings settings;
  if (baseline.find('=') == std::string::npos) {
    settings.Set("row", baseline);
  } else {
    settings = ParseSettings(baseline, "baseline");
  }
  for (const auto& entry : settings.entries()) {
    const bool known = std::find(table.keys.begin(), table.keys.end(),
                                 entry.first) != table.keys.end();
    CheckOption(
        known, "baseline", baseline,
        "a row's name, or keys that vary; " + entry.first + " does not");
  }
  return settings;
}

bool IsBaseline(const ResultRow& row, const Settings& baseline) {
  return std::all_of(baseline.entries().begin(), baseline.entries().end(),
                     [&](const Settings::Entry& entry) {
                       return ValueOf(row.task, entry.first) == entry.second;
                     });
}

/// Runs of the baseline, at least one.
std::vector<const ResultRow*> FindCandidates(const ResultTable& table,
                                             const std::string& baseline) {
  const Settings wanted = ReadBaseline(table, baseline);
  std::vector<const ResultRow*> candidates;
  for (const ResultRow& row : table.rows) {
    if (IsBaseline(row, wanted)) candidates.push_back(&row);
  }
  CheckOption(!candidates.empty(), "baseline", baseline,
              "the row or the values of some runs");
  return candidates;
}

/// Whether two rows agree in all keys of designs but those of the baseline.
bool AgreeOtherwise(const ResultTable& table, const Settings& baseline,
                    const ResultRow& a, const ResultRow& b) {
  return std::all_of(table.design.begin(), table.design.end(),
                     [&](const std::string& key) {
                       return baseline.Find(key) != nullptr ||
                              ValueOf(a.task, key) == ValueOf(b.task, key);
                     });
}

/// The run that `row` is compared with; null if there is none, or several.
const ResultRow* FindPartner(const ResultTable& table, const Settings& baseline,
                             const std::vector<const ResultRow*>& candidates,
                             const ResultRow& row) {
  std::vector<const ResultRow*> same, agreeing;
  for (const ResultRow* candidate : candidates) {
    if (candidate->task.sequence != row.task.sequence ||
        candidate->task.repeat != row.task.repeat) {
      continue;
    }
    same.push_back(candidate);
    if (AgreeOtherwise(table, baseline, *candidate, row)) {
      agreeing.push_back(candidate);
    }
  }
  const auto& found = agreeing.empty() ? same : agreeing;
  return found.size() == 1 ? found.front() : nullptr;
}

void AddDifference(const ResultRow& row, const ResultRow& partner,
                   Gathered* gathered) {
  ++gathered->group.planned;
  if (!row.IsComplete() || !partner.IsComplete()) return;
  ++gathered->group.runs;
  for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
    gathered->values[i].push_back(row.figures.values[i] -
                                  partner.figures.values[i]);
  }
  gathered->seconds.push_back(row.cost.wall_seconds);
}

}  // namespace

double Spread::StandardError() const {
  return standard_deviation / std::sqrt(static_cast<double>(count));
}

Spread DescribeValues(const std::vector<double>& values) {
  Spread spread{0, kNone, kNone};
  double sum = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    ++spread.count;
    sum += value;
  }
  if (spread.count == 0) return spread;
  spread.mean = sum / spread.count;
  if (spread.count < 2) return spread;
  double squares = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    squares += (value - spread.mean) * (value - spread.mean);
  }
  spread.standard_deviation = std::sqrt(squares / (spread.count - 1));
  return spread;
}

std::vector<ResultGroup> GroupResults(const ResultTable& table) {
  Groups groups;
  for (const ResultRow& row : table.rows) {
    Gathered& gathered = groups.At(row.task.sequence, row.values);
    ++gathered.group.planned;
    if (!row.IsComplete()) continue;
    ++gathered.group.runs;
    for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
      gathered.values[i].push_back(row.figures.values[i]);
    }
    gathered.seconds.push_back(row.cost.wall_seconds);
  }
  return groups.Describe();
}

void CheckBaseline(const ResultTable& table, const std::string& baseline) {
  FindCandidates(table, baseline);
}

std::vector<ResultGroup> CompareWithBaseline(const ResultTable& table,
                                             const std::string& baseline) {
  const Settings wanted = ReadBaseline(table, baseline);
  const std::vector<const ResultRow*> candidates =
      FindCandidates(table, baseline);
  std::set<std::string> sequences;
  for (const ResultRow& row : table.rows) sequences.insert(row.task.sequence);
  Groups groups, over_all;
  for (const ResultRow& row : table.rows) {
    if (IsBaseline(row, wanted)) continue;
    const ResultRow* partner = FindPartner(table, wanted, candidates, row);
    if (partner == nullptr) continue;
    AddDifference(row, *partner, &groups.At(row.task.sequence, row.values));
    AddDifference(row, *partner, &over_all.At(kAllSequences, row.values));
  }
  std::vector<ResultGroup> described = groups.Describe();
  if (sequences.size() < 2) return described;
  for (ResultGroup& group : over_all.Describe()) described.push_back(group);
  return described;
}

}  // namespace splitfusion
