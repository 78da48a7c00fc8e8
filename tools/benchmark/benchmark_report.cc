#include "benchmark_report.h"

#include <algorithm>
#include <iomanip>

#include "splitfusion/lib/base/median.h"

namespace splitfusion {
namespace {

/// Name of a run without what Google Benchmark appends of its settings.
std::string NameOf(const benchmark::BenchmarkReporter::Run& run) {
  const std::string& arguments = run.run_name.args;
  return run.run_name.function_name + (arguments.empty() ? "" : "/") +
         arguments;
}

/// What programs ask of gn_iteration, where its companions have been run.
void AddRatios(nlohmann::json* row) {
  const nlohmann::json companions = row->value("companions", nlohmann::json());
  const auto add = [&](const char* name, const char* above, double below) {
    if (companions.contains(above) && below > 0) {
      (*row)[name] = companions[above].get<double>() / below;
    }
  };
  const double time = row->at("time");
  add("reference_36_over_gn_pcg", "reference_36", time);
  add("reference_36_over_ceres_grouped", "reference_36",
      companions.value("ceres_grouped", 0.0));
  add("custom_term_over_builtin", "custom_term", time);
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
      errors_.insert(name + ": " + run.error_message);
    }
  }
}

nlohmann::json BenchmarkReport::ToJson() const {
  nlohmann::json rows = nlohmann::json::object();
  for (const auto& [name, seconds] : seconds_) {  // Rows before companions.
    const std::size_t slash = name.find('/');
    const std::string row_name = name.substr(0, slash);
    const double median = Median(seconds);
    if (slash == std::string::npos) {
      rows[name] = {
          {"time", median}, {"floor", nullptr}, {"over_floor", nullptr}};
    } else if (rows.contains(row_name)) {
      nlohmann::json& row = rows[row_name];
      const std::string companion = name.substr(slash + 1);
      if (companion == "floor") {
        row["floor"] = median;
        row["over_floor"] = row["time"].get<double>() / median;
      } else {
        row["companions"][companion] = median;
      }
    }
  }
  if (rows.contains("gn_iteration")) AddRatios(&rows["gn_iteration"]);
  return rows;
}

void BenchmarkReport::PrintTable(std::ostream* out) const {
  *out << std::left << std::setw(24) << "benchmark" << std::right
       << std::setw(12) << "time ms" << std::setw(12) << "floor ms"
       << std::setw(12) << "over floor" << std::fixed << '\n';
  const auto print = [&](const nlohmann::json& value, int digits,
                         double scale) {
    *out << std::setw(12) << std::setprecision(digits);
    value.is_null() ? *out << "-" : *out << scale * value.get<double>();
  };
  const nlohmann::json rows = ToJson();
  for (const auto& [name, row] : rows.items()) {
    *out << std::left << std::setw(24) << name << std::right;
    print(row["time"], 3, 1e3);
    print(row["floor"], 3, 1e3);
    print(row["over_floor"], 2, 1);
    const nlohmann::json companions =
        row.value("companions", nlohmann::json::object());
    for (const auto& [companion, seconds] : companions.items()) {
      *out << "  " << companion << ' '
           << seconds.get<double>() / row["time"].get<double>() << 'x';
    }
    *out << '\n';
  }
  for (const auto& [name, message] : skipped_) {
    *out << std::left << std::setw(24) << name << "  " << message << '\n';
  }
}

}  // namespace splitfusion
