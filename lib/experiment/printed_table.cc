#include "splitfusion/lib/experiment/printed_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <sstream>

namespace splitfusion {
namespace {

using Lines = std::vector<std::string>;

/// How a figure is shown.
struct Shown {
  const char* name;    ///< One of kFigureNames.
  const char* head;    ///< Of the column.
  double factor;       ///< From SI to the column's unit.
  int decimals;        ///< Behind the point.
  const char* effect;  ///< Head of the column of effects, points or percent.
};

/// What the lines of a table are.
enum class Lined { kMeans, kDifferences, kEffects };

/// In this order where they tell equally much, ATE first.
constexpr std::array<Shown, 16> kShown = {{
    {"ate_m", "ATE mm", 1000, 2, "ATE %"},
    {"f_score_seen", "F seen %", 100, 1, "F seen pt"},
    {"missing", "missing %", 100, 1, "missing pt"},
    {"stretched", "stretched %", 100, 2, "stretched pt"},
    {"ghosts", "ghosts %", 100, 2, "ghosts pt"},
    {"surface_error_m", "surface mm", 1000, 1, "surface %"},
    {"tracks_mean_m", "tracks mm", 1000, 1, "tracks %"},
    {"view_error_m", "view mm", 1000, 1, "view %"},
    {"lost_frames", "lost frames", 1, 1, "lost frames"},
    {"seconds_per_frame", "s/frame", 1, 3, "s/frame %"},
    {"rpe_m", "RPE mm", 1000, 2, "RPE %"},
    {"rpe_deg", "RPE deg", 1, 3, "RPE angle %"},
    {"tracks_median_m", "tracks median mm", 1000, 1, "tracks median %"},
    {"cpu_seconds_per_frame", "CPU s/frame", 1, 3, "CPU %"},
    {"peak_memory_bytes", "memory MB", 1e-6, 0, "memory %"},
    {"frames", "frames", 1, 0, "frames"},
}};

/// A column of the table.
struct Column {
  std::string head;
  Lines cells;
  bool is_text = false;  ///< Flush left.

  std::size_t Width() const {
    std::size_t width = head.size();
    for (const std::string& cell : cells) width = std::max(width, cell.size());
    return width;
  }
};

std::string Number(double value, int decimals, bool with_sign) {
  return cv::format(with_sign ? "%+.*f" : "%.*f", decimals, value);
}

/// Enough digits for a scatter to be told from zero, unless it is the rounding
/// of sums.
int Decimals(double scatter, int least) {
  constexpr int kMost = 9;
  for (int decimals = least; decimals <= kMost; ++decimals) {
    const std::string text = Number(scatter, decimals, false);
    if (std::atof(text.c_str()) != 0) return decimals;
  }
  return least;
}

/// "12.5", or "12.5+-0.3" if the scatter is known.
std::string SpreadText(const Spread& spread, double scatter, const Shown& shown,
                       bool with_sign) {
  if (spread.count == 0) return "-";
  scatter *= shown.factor;
  const int decimals = Decimals(scatter, shown.decimals);
  std::string text = Number(spread.mean * shown.factor, decimals, with_sign);
  if (std::isfinite(scatter)) text += "+-" + Number(scatter, decimals, false);
  return text;
}

/// Standard deviation within the groups; NaN if none has two values.
double PooledDeviation(const std::vector<ResultGroup>& groups,
                       std::size_t index) {
  double squares = 0;
  int freedom = 0;
  for (const ResultGroup& group : groups) {
    const Spread& spread = group.figures[index];
    if (spread.count < 2) continue;
    freedom += spread.count - 1;
    squares += (spread.count - 1) * spread.standard_deviation *
               spread.standard_deviation;
  }
  return std::sqrt(squares / freedom);
}

/// The greatest difference to the baseline, or between two groups of a
/// sequence.
double LargestEffect(const std::vector<ResultGroup>& groups, std::size_t index,
                     Lined lined) {
  std::map<std::string, std::pair<double, double>> ranges;
  double effect = 0;
  for (const ResultGroup& group : groups) {
    const double mean = group.figures[index].mean;
    if (!std::isfinite(mean)) continue;
    const double first = lined == Lined::kMeans ? mean : 0;
    auto& [low, high] =
        ranges.try_emplace(group.sequence, first, first).first->second;
    low = std::min(low, mean);
    high = std::max(high, mean);
    effect = std::max(effect, high - low);
  }
  return effect;
}

/// How much a figure tells: its effect in scatters. Without a scatter an effect
/// is more than none.
double Telling(const std::vector<ResultGroup>& groups, std::size_t index,
               Lined lined) {
  const double effect = LargestEffect(groups, index, lined);
  const double deviation = PooledDeviation(groups, index);
  if (effect == 0) return 0;
  return std::isfinite(deviation) ? effect / deviation : 1;
}

/// As the effect on the figure is shown: of one decimal, in percent or points.
Shown Effect(Shown shown) {
  constexpr double kPercent = 100;
  if (IsRatio(FigureColumn(shown.name))) shown.factor = kPercent;
  shown.head = shown.effect;
  shown.decimals = 1;
  return shown;
}

/// The figures in the order in which they are shown: ATE first, then what tells
/// most.
std::vector<Shown> InOrder(const std::vector<ResultGroup>& groups,
                           Lined lined) {
  std::vector<std::pair<double, Shown>> order;
  for (const Shown& shown : kShown) {
    const bool headline = std::string(shown.name) == "ate_m";
    order.emplace_back(headline
                           ? std::numeric_limits<double>::infinity()
                           : Telling(groups, FigureColumn(shown.name), lined),
                       lined == Lined::kEffects ? Effect(shown) : shown);
  }
  std::stable_sort(
      order.begin(), order.end(),
      [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Shown> figures;
  for (const auto& [telling, shown] : order) figures.push_back(shown);
  return figures;
}

/// The head of a figure's column; the unit is SI's multiple.
std::vector<Column> FigureColumns(const std::vector<ResultGroup>& groups,
                                  Lined lined) {
  std::vector<Column> columns;
  for (const Shown& shown : InOrder(groups, lined)) {
    const std::size_t index = FigureColumn(shown.name);
    Column column{shown.head, {}, false};
    bool known = false;
    for (const ResultGroup& group : groups) {
      const Spread& spread = group.figures[index];
      known = known || spread.count > 0;
      const bool compared = lined != Lined::kMeans;
      const double scatter =
          compared ? spread.StandardError() : spread.standard_deviation;
      column.cells.push_back(SpreadText(spread, scatter, shown, compared));
    }
    if (known) columns.push_back(column);
  }
  return columns;
}

/// Text without its middle.
std::string Shortened(const std::string& text, std::size_t width) {
  if (text.size() <= width) return text;
  if (width < 5) return text.substr(0, width);
  const std::size_t tail = (width - 2) / 2;
  return text.substr(0, width - 2 - tail) + ".." +
         text.substr(text.size() - tail);
}

bool Varies(const Column& column) {
  return std::set<std::string>(column.cells.begin(), column.cells.end())
             .size() > 1;
}

/// What tells the lines apart: sequence, varied keys, number of runs.
std::vector<Column> NameColumns(const ResultTable& table,
                                const std::vector<ResultGroup>& groups,
                                bool all_keys) {
  std::vector<Column> columns = {{"sequence", {}, true}};
  for (const ResultGroup& group : groups) {
    columns[0].cells.push_back(group.sequence);
  }
  for (std::size_t i = 0; i < table.keys.size(); ++i) {
    Column column{table.keys[i], {}, true};
    for (const ResultGroup& group : groups) {
      column.cells.push_back(group.values[i].empty() ? "-" : group.values[i]);
    }
    if (all_keys || Varies(column)) columns.push_back(column);
  }
  Column runs{"n", {}, false};
  for (const ResultGroup& group : groups) {
    std::string text = std::to_string(group.runs);
    if (group.runs < group.planned) text += "/" + std::to_string(group.planned);
    runs.cells.push_back(text);
  }
  columns.push_back(runs);
  return columns;
}

void ShortenTo(std::size_t width, Column* column) {
  column->head = Shortened(column->head, width);
  for (std::string& cell : column->cells) cell = Shortened(cell, width);
}

std::size_t TotalWidth(const std::vector<Column>& columns) {
  std::size_t width = 0;
  for (const Column& column : columns) width += column.Width() + 2;
  return width < 2 ? 0 : width - 2;
}

/// Shortens names until they leave room for a figure or two; names of columns
/// that had to go whole, where they alone would be too wide.
Lines FitNames(std::size_t width, std::vector<Column>* columns) {
  constexpr std::size_t kRoomForFigures = 28;
  const std::size_t room =
      width > 2 * kRoomForFigures ? width - kRoomForFigures : width / 2;
  for (std::size_t limit = 24; limit >= 4 && TotalWidth(*columns) > room;
       limit -= 4) {
    for (Column& column : *columns) ShortenTo(limit, &column);
  }
  Lines dropped;
  while (columns->size() > 1 && TotalWidth(*columns) > width) {
    // The number of runs is last, and stays.
    const std::size_t place = columns->size() > 2 ? columns->size() - 2 : 1;
    dropped.push_back((*columns)[place].head);
    columns->erase(columns->begin() + static_cast<std::ptrdiff_t>(place));
  }
  if (TotalWidth(*columns) > width) ShortenTo(width, &columns->front());
  return dropped;
}

std::string Line(const std::vector<Column>& columns, std::size_t width,
                 const std::function<std::string(const Column&)>& cell_of) {
  std::string line;
  for (const Column& column : columns) {
    const std::string cell = cell_of(column);
    const std::string blanks(column.Width() - cell.size(), ' ');
    line += line.empty() ? "" : "  ";
    line += column.is_text ? cell + blanks : blanks + cell;
  }
  const std::size_t end = line.find_last_not_of(' ');
  return line.substr(0,
                     std::min(width, end == std::string::npos ? 0 : end + 1)) +
         "\n";
}

/// Words in lines of `width`.
std::string Wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string lines, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word.substr(0, width);
  }
  return line.empty() ? lines : lines + line + "\n";
}

/// The columns side by side, as many figures as fit, the others named below.
std::string Fitted(std::vector<Column> columns,
                   const std::vector<Column>& figures, std::size_t width) {
  Lines dropped = FitNames(width, &columns);
  std::size_t used = TotalWidth(columns);
  for (const Column& figure : figures) {
    if (used + 2 + figure.Width() > width) {
      dropped.push_back(figure.head);
      continue;
    }
    used += 2 + figure.Width();
    columns.push_back(figure);
  }
  std::string text =
      Line(columns, width, [](const Column& column) { return column.head; });
  for (std::size_t i = 0; i < columns.front().cells.size(); ++i) {
    text += Line(columns, width,
                 [i](const Column& column) { return column.cells[i]; });
  }
  if (dropped.empty()) return text;
  std::string names;
  for (const std::string& name : dropped) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return text + Wrapped("Not shown (in the files): " + names + ".", width);
}

/// Lines of a comparison, with the seconds of a run.
std::string ComparedLines(const ResultTable& table,
                          const std::vector<ResultGroup>& groups, Lined lined,
                          std::size_t width) {
  std::vector<Column> names = NameColumns(table, groups, /*all_keys=*/true);
  Column seconds{"s/run", {}, false};
  for (const ResultGroup& group : groups) {
    seconds.cells.push_back(
        group.seconds.count == 0 ? "-" : Number(group.seconds.mean, 1, false));
  }
  names.push_back(seconds);
  return Fitted(names, FigureColumns(groups, lined), width);
}

}  // namespace

std::string PrintedSummary(const ResultTable& table,
                           const std::vector<ResultGroup>& groups,
                           std::size_t width) {
  if (groups.empty()) return "No runs.\n";
  const bool repeated =
      std::any_of(groups.begin(), groups.end(),
                  [](const ResultGroup& group) { return group.planned > 1; });
  std::string text = Fitted(NameColumns(table, groups, /*all_keys=*/false),
                            FigureColumns(groups, Lined::kMeans), width);
  if (repeated) {
    text += Wrapped("Mean +- standard deviation over n repeats.", width);
  }
  return text;
}

std::string PrintedDifferences(const ResultTable& table,
                               const Comparison& comparison,
                               const std::string& baseline, std::size_t width) {
  const std::vector<ResultGroup>& groups = comparison.groups;
  std::string unpaired;
  if (comparison.unpaired > 0) {
    unpaired = Wrapped(std::to_string(comparison.unpaired) +
                           " runs are not compared: no run of " + baseline +
                           " has the same sequence, repeat and other options.",
                       width);
  }
  if (groups.empty()) {
    return Wrapped("Nothing to compare with " + baseline + ".", width) +
           unpaired;
  }
  const std::string differences =
      Wrapped("Differences to " + baseline +
                  ", run by run of the same sequence and repeat: mean +- "
                  "standard error.",
              width) +
      ComparedLines(table, groups, Lined::kDifferences, width) + unpaired;
  if (comparison.effects.empty()) return differences;
  return differences + "\n" +
         Wrapped(
             "Effects over the sequences: mean +- standard error of the "
             "log ratio, of shares and counts of the difference.",
             width) +
         ComparedLines(table, comparison.effects, Lined::kEffects, width);
}

}  // namespace splitfusion
