#include "splitfusion/lib/experiment/sweep_page.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "splitfusion/lib/page/html_page.h"
#include "splitfusion/lib/page/html_tables.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

/// More lines in one chart cannot be told apart; more runs are not listed.
constexpr std::size_t kAxisCharacters = 12;  // Layout.
constexpr std::size_t kLines = 24;           // Layout.
constexpr std::size_t kRuns = 1000;          // Layout.
constexpr double kNoMean = std::numeric_limits<double>::quiet_NaN();

/// Numbers by size, before texts, which are as they come in the alphabet.
bool ComesBefore(const std::string& a, const std::string& b) {
  char* end_a = nullptr;
  char* end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a);
  const double y = std::strtod(b.c_str(), &end_b);
  const bool is_x = !a.empty() && *end_a == '\0';
  const bool is_y = !b.empty() && *end_b == '\0';
  if (is_x && is_y && x != y) return x < y;
  if (is_x != is_y) return is_x;
  return a < b;
}

/// The values of a key in all groups, in order; as it is not set, "default".
std::vector<std::string> ValuesOfKey(const std::vector<ResultGroup>& groups,
                                     std::size_t key) {
  std::set<std::string> values;
  for (const ResultGroup& group : groups) values.insert(group.values[key]);
  std::vector<std::string> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end(), ComesBefore);
  return sorted;
}

/// The key with the most values.
std::size_t WidestKey(const std::vector<ResultGroup>& groups,
                      std::size_t keys) {
  std::size_t widest = 0, most = 0;
  for (std::size_t key = 0; key < keys; ++key) {
    const std::size_t count = ValuesOfKey(groups, key).size();
    if (count <= most) continue;
    widest = key;
    most = count;
  }
  return widest;
}

/// The line of a group: its sequence, and what else is set than the axis' key.
std::string LineOf(const ResultGroup& group,
                   const std::vector<std::string>& keys, std::size_t axis) {
  std::string name = group.sequence;
  for (std::size_t key = 0; key < keys.size(); ++key) {
    if (key == axis || group.values[key].empty()) continue;
    name += " " + keys[key] + "=" + group.values[key];
  }
  return name;
}

/// What stands below an axis: values that are short enough, or else letters.
std::vector<std::string> ShortNames(const std::vector<std::string>& values) {
  const bool all_short = std::all_of(
      values.begin(), values.end(),
      [](const std::string& value) { return value.size() <= kAxisCharacters; });
  std::vector<std::string> names;
  for (const std::string& value : values) {
    const std::size_t place = names.size();
    const std::string letter = {static_cast<char>('A' + place % 26)};
    const std::string round = place < 26 ? "" : std::to_string(place / 26 + 1);
    names.push_back(!all_short      ? letter + round
                    : value.empty() ? "default"
                                    : value);
  }
  return names;
}

/// What the letters stand for; empty if there are none.
std::string KeyOfNames(const std::vector<std::string>& values) {
  const std::vector<std::string> names = ShortNames(values);
  std::string html;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (names[i] == values[i] || names[i] == "default") continue;
    html += "<li>" + names[i] + ": " +
            HtmlEscaped(values[i].empty() ? "default" : values[i]) + "</li>\n";
  }
  return html.empty() ? "" : "<ul>\n" + html + "</ul>\n";
}

/// A figure of all groups; without series if none knows it.
Chart ChartOfFigure(const std::vector<ResultGroup>& groups,
                    const std::vector<std::string>& keys, std::size_t figure) {
  const std::size_t axis = WidestKey(groups, keys.size());
  const std::vector<std::string> values = ValuesOfKey(groups, axis);
  std::map<std::string, ChartSeries> lines;
  for (const ResultGroup& group : groups) {
    const Spread& spread = group.figures[figure];
    if (spread.count == 0) continue;
    const std::string name = LineOf(group, keys, axis);
    ChartSeries& line = lines[name];
    if (line.values.empty()) {
      line = {name, std::vector<double>(values.size(), kNoMean),
              std::vector<double>(values.size(), kNoMean)};
    }
    const auto place =
        std::find(values.begin(), values.end(), group.values[axis]) -
        values.begin();
    line.values[place] = spread.mean;
    line.spread[place] = spread.StandardError();
  }
  Chart chart;
  chart.title = kFigureNames[figure] + (" over " + keys[axis]);
  chart.axis = keys[axis];
  chart.names = ShortNames(values);
  for (const auto& [name, line] : lines) chart.series.push_back(line);
  return chart;
}

void AddCharts(const ResultTable& table, const std::vector<ResultGroup>& groups,
               HtmlPage* page) {
  if (table.keys.empty() || groups.empty()) return;
  const std::size_t axis = WidestKey(groups, table.keys.size());
  std::set<std::string> lines;
  for (const ResultGroup& group : groups) {
    lines.insert(LineOf(group, table.keys, axis));
  }
  if (lines.size() > kLines) {
    page->Add("<p>No charts: they would have " + std::to_string(lines.size()) +
              " lines; see summary.csv.</p>\n");
    return;
  }
  page->Add(
      "<p>Means over the repeats; bars are their standard errors.</p>\n"
      "<div class=\"charts\">\n");
  for (std::size_t figure = 0; figure < kFigureNames.size(); ++figure) {
    const Chart chart = ChartOfFigure(groups, table.keys, figure);
    if (!chart.series.empty()) page->AddChart(chart, "sweep");
  }
  page->Add("</div>\n" + KeyOfNames(ValuesOfKey(groups, axis)));
}

/// A table of cells as one of a page.
Json RowsOf(const FileTable& table) {
  Json rows = Json::array();
  for (const std::vector<Cell>& cells : table.rows) {
    Json row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Cell& cell = cells[i];
      row[table.columns[i]] = cell.text.empty() ? Json()
                              : cell.is_number  ? Json(cell.number)
                                                : Json(cell.text);
    }
    rows.push_back(row);
  }
  return rows;
}

/// Of a URL below the folder of the page: percent signs for what is special.
std::string UrlOf(const std::string& path) {
  static const std::string plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string url;
  for (const char c : path) {
    if (plain.find(c) != std::string::npos) {
      url += c;
      continue;
    }
    static const char* digits = "0123456789ABCDEF";
    const auto byte = static_cast<unsigned char>(c);
    url += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return url;
}

/// All runs, with what became of them, and links to the pages of those that
/// have one.
std::string Runs(const ExperimentFolder& folder, const ResultTable& table) {
  std::string html = "<ul>\n";
  const std::size_t shown = std::min(table.rows.size(), kRuns);
  for (std::size_t i = 0; i < shown; ++i) {
    const ResultRow& row = table.rows[i];
    std::string name = HtmlEscaped(row.task.name);
    const std::string page = "tasks/" + row.task.name + "/run/report.html";
    if (std::filesystem::exists(folder.Below(page))) {
      name = "<a href=\"" + UrlOf(page) + "\">" + name + "</a>";
    }
    html += "<li>" + name + " " + HtmlEscaped(SettingsText(row.task.settings)) +
            ": " + HtmlEscaped(row.status) +
            (row.error.empty() ? "" : ": " + HtmlEscaped(row.error)) +
            "</li>\n";
  }
  html += "</ul>\n";
  if (shown == table.rows.size()) return html;
  return html + "<p>and " + std::to_string(table.rows.size() - shown) +
         " more, see results.csv</p>\n";
}

}  // namespace

std::string SweepPage(const ExperimentFolder& folder, const ResultTable& table,
                      const std::vector<ResultGroup>& groups,
                      const std::vector<FileTable>& tables) {
  HtmlPage page;
  const auto complete =
      std::count_if(table.rows.begin(), table.rows.end(),
                    [](const ResultRow& row) { return row.IsComplete(); });
  page.Add("<h1>SplitFusion experiment</h1>\n<p>" + std::to_string(complete) +
           " of " + std::to_string(table.rows.size()) +
           " runs are complete; only these have figures.</p>\n");
  AddCharts(table, groups, &page);
  for (const FileTable& one : tables) {
    page.Add(Heading(one.name) + RowTable(RowsOf(one)));
  }
  page.Add(Heading("Runs") + Runs(folder, table));
  return page.Text();
}

}  // namespace splitfusion
