#include "benchmark_report.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include "splitfusion/lib/report/run_summary.h"

namespace splitfusion {
namespace {

constexpr char kFloor[] = "floor";

/// Name of a run without what Google Benchmark appends of its settings.
std::string NameOf(const benchmark::BenchmarkReporter::Run& run) {
  const std::string& arguments = run.run_name.args;
  return run.run_name.function_name + (arguments.empty() ? "" : "/") +
         arguments;
}

std::string Fixed(double value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

std::string Milliseconds(double seconds) { return Fixed(1e3 * seconds, 3); }

void PrintLine(const std::string& name, const std::string& time,
               const std::string& floor, const std::string& over_floor,
               const std::string& companions, std::ostream* out) {
  *out << std::left << std::setw(24) << name << std::right << std::setw(12)
       << time << std::setw(12) << floor << std::setw(12) << over_floor
       << (companions.empty() ? "" : "  ") << companions << '\n';
}

}  // namespace

void BenchmarkReport::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration) continue;
    const std::string name = NameOf(run);
    if (!run.error_occurred) {
      seconds_[name].push_back(run.real_accumulated_time /
                               static_cast<double>(run.iterations));
    } else if (run.error_message.rfind(kSkipped, 0) == 0) {
      skipped_[name] = run.error_message;
    } else {
      const std::string error = name + ": " + run.error_message;
      if (std::find(errors_.begin(), errors_.end(), error) == errors_.end()) {
        errors_.push_back(error);
      }
    }
  }
}

std::map<std::string, BenchmarkReport::Row> BenchmarkReport::Rows() const {
  std::map<std::string, Row> rows;
  for (const auto& [name, seconds] : seconds_) {
    if (name.find('/') == std::string::npos) rows[name].time = Median(seconds);
  }
  for (const auto& [name, seconds] : seconds_) {
    const std::size_t slash = name.find('/');
    const auto row = rows.find(name.substr(0, slash));
    if (slash == std::string::npos || row == rows.end()) continue;
    row->second.companions[name.substr(slash + 1)] = Median(seconds);
  }
  return rows;
}

void BenchmarkReport::PrintTable(std::ostream* out) const {
  PrintLine("benchmark", "time ms", "floor ms", "over floor", "", out);
  for (const auto& [name, row] : Rows()) {
    std::string floor = "-", over_floor = "-", companions;
    for (const auto& [companion, seconds] : row.companions) {
      if (companion == kFloor) {
        floor = Milliseconds(seconds);
        over_floor = Fixed(row.time / seconds, 2);
        continue;
      }
      companions += (companions.empty() ? "" : ", ") + companion + " " +
                    Fixed(seconds / row.time, 2) + "x";
    }
    PrintLine(name, Milliseconds(row.time), floor, over_floor, companions, out);
  }
  for (const auto& [name, message] : skipped_) {
    *out << std::left << std::setw(24) << name << "  " << message << '\n';
  }
}

std::map<std::string, double> BenchmarkReport::Ratios(const Row& row) {
  std::map<std::string, double> ratios;
  const auto reference = row.companions.find("reference_36");
  const auto grouped = row.companions.find("ceres_grouped");
  const auto custom = row.companions.find("custom_term");
  if (reference != row.companions.end()) {
    ratios["reference_36_over_gn_pcg"] = reference->second / row.time;
    if (grouped != row.companions.end()) {
      ratios["reference_36_over_ceres_grouped"] =
          reference->second / grouped->second;
    }
  }
  if (custom != row.companions.end()) {
    ratios["custom_term_over_builtin"] = custom->second / row.time;
  }
  return ratios;
}

nlohmann::json BenchmarkReport::ToJson() const {
  nlohmann::json all = nlohmann::json::object();
  for (const auto& [name, row] : Rows()) {
    nlohmann::json& entry = all[name];
    entry = {{"time", row.time}, {"floor", nullptr}, {"over_floor", nullptr}};
    for (const auto& [companion, seconds] : row.companions) {
      if (companion == kFloor) {
        entry["floor"] = seconds;
        entry["over_floor"] = row.time / seconds;
      } else {
        entry["companions"][companion] = seconds;
      }
    }
    if (name == "gn_iteration") entry.update(nlohmann::json(Ratios(row)));
  }
  return all;
}

}  // namespace splitfusion
