#include "splitfusion/lib/experiment/result_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/experiment/repeats.h"

namespace splitfusion {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
using FigureValues = std::array<std::vector<double>, kFigureNames.size()>;

/// Rows of one group, as they come.
struct Gathered {
  ResultGroup group;
  FigureValues values;
  std::vector<double> seconds;

  /// Counts a run, complete or not, with these figures.
  void Add(const ResultRow& row, bool complete, const Figures& figures) {
    ++group.planned;
    if (!complete) return;
    ++group.runs;
    AddValues([&](std::size_t i) { return figures.values[i]; });
    seconds.push_back(row.cost.wall_seconds);
  }

  /// Counts the runs of a group by their means.
  void Add(const ResultGroup& part) {
    group.planned += part.planned;
    group.runs += part.runs;
    AddValues([&](std::size_t i) { return part.figures[i].mean; });
    seconds.push_back(part.seconds.mean);
  }

 private:
  template <typename ValueOf>
  void AddValues(const ValueOf& value_of) {
    for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
      values[i].push_back(value_of(i));
    }
  }
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

/// Keys in which a run may differ from its partner.
std::set<std::string> FreeKeys(const Settings& baseline, const ResultRow& a,
                               const ResultRow& b) {
  std::set<std::string> keys;
  for (const auto& entry : baseline.entries()) keys.insert(entry.first);
  if (keys.count("row") == 0) return keys;
  for (const ResultRow* row : {&a, &b}) {
    keys.insert(row->task.grouped.begin(), row->task.grouped.end());
  }
  return keys;
}

/// Whether a setting is the same, or was resolved to the same.
bool HasSameValue(const std::string& key, const ResultRow& a,
                  const ResultRow& b) {
  if (ValueOf(a.task, key) == ValueOf(b.task, key)) return true;
  const auto in_a = a.parts.find(key), in_b = b.parts.find(key);
  return in_a != a.parts.end() && in_b != b.parts.end() &&
         in_a->second == in_b->second;
}

bool HaveSameSettings(const std::set<std::string>& free, const ResultRow& a,
                      const ResultRow& b) {
  for (const ResultRow* row : {&a, &b}) {
    for (const auto& entry : row->task.settings.entries()) {
      const std::string& key = entry.first;
      if (free.count(key) == 0 && !HasSameValue(key, a, b)) return false;
    }
  }
  return true;
}

/// Whether a key is an option that sets no other one.
bool SetsItselfAlone(const std::string& key, const NamedValues& parts) {
  return key == "row" || (key != "preset" && parts.count(key) > 0);
}

/// What decides the result, without what these keys set.
NamedValues PartsBut(const std::set<std::string>& free, NamedValues parts) {
  for (const std::string& key : free) {
    parts.erase(key);
    if (key != "terms") continue;
    for (auto part = parts.begin(); part != parts.end();) {
      part = IsTermKey(part->first) ? parts.erase(part) : std::next(part);
    }
  }
  return parts;
}

/// Whether two runs agree in all that decides results but for `free` keys.
bool AgreeBut(const std::set<std::string>& free, const ResultRow& a,
              const ResultRow& b) {
  if (!HaveSameSettings(free, a, b)) return false;
  const bool comparable =
      !a.parts.empty() && !b.parts.empty() &&
      std::all_of(free.begin(), free.end(), [&](const std::string& key) {
        return SetsItselfAlone(key, a.parts) || SetsItselfAlone(key, b.parts);
      });
  return !comparable || DifferencesBeyondRepeats(PartsBut(free, a.parts),
                                                 PartsBut(free, b.parts))
                            .empty();
}

/// Whether another system has made it.
bool IsForeign(const ResultRow& row) {
  return row.IsComplete() && row.identity.empty() && !row.task.row.empty() &&
         row.task.settings.empty();
}

/// The run that `row` is compared with; null if there is none.
const ResultRow* FindPartner(const Settings& baseline,
                             const std::vector<const ResultRow*>& candidates,
                             const ResultRow& row) {
  std::vector<const ResultRow*> found;
  for (const ResultRow* candidate : candidates) {
    const bool same = candidate->task.sequence == row.task.sequence &&
                      candidate->task.repeat == row.task.repeat;
    if (!same) continue;
    const auto free = FreeKeys(baseline, *candidate, row);
    if (IsForeign(row) || AgreeBut(free, *candidate, row)) {
      found.push_back(candidate);
    }
  }
  const bool none = found.empty() || (IsForeign(row) && found.size() > 1);
  return none ? nullptr : found.front();
}

/// The groups of all sequences as one, by the means of each.
std::vector<ResultGroup> OverSequences(const std::vector<ResultGroup>& groups) {
  Groups pooled;
  for (const ResultGroup& group : groups) {
    pooled.At(kAllSequences, group.values).Add(group);
  }
  return pooled.Describe();
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
    groups.At(row.task.sequence, row.values)
        .Add(row, row.IsComplete(), row.figures);
  }
  return groups.Describe();
}

void CheckBaseline(const ResultTable& table, const std::string& baseline) {
  FindCandidates(table, baseline);
}

Comparison CompareWithBaseline(const ResultTable& table,
                               const std::string& baseline) {
  const Settings wanted = ReadBaseline(table, baseline);
  const std::vector<const ResultRow*> candidates =
      FindCandidates(table, baseline);
  std::set<std::string> sequences;
  for (const ResultRow& row : table.rows) sequences.insert(row.task.sequence);
  Comparison comparison;
  Groups groups, effects;
  for (const ResultRow& row : table.rows) {
    if (IsBaseline(row, wanted)) continue;
    const ResultRow* partner = FindPartner(wanted, candidates, row);
    if (partner == nullptr) {
      comparison.unpaired += row.IsComplete() ? 1 : 0;
      continue;
    }
    const bool complete = row.IsComplete() && partner->IsComplete();
    Figures differences, effect;
    for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
      const double value = row.figures.values[i];
      differences.values[i] = value - partner->figures.values[i];
      effect.values[i] = EffectOn(i, value, partner->figures.values[i]);
    }
    groups.At(row.task.sequence, row.values).Add(row, complete, differences);
    effects.At(row.task.sequence, row.values).Add(row, complete, effect);
  }
  comparison.groups = groups.Describe();
  if (sequences.size() > 1) {
    comparison.effects = OverSequences(effects.Describe());
  }
  return comparison;
}

}  // namespace splitfusion
