#ifndef SPLITFUSION_TOOLS_BENCHMARK_BENCHMARK_REPORT_H_
#define SPLITFUSION_TOOLS_BENCHMARK_BENCHMARK_REPORT_H_

#include <benchmark/benchmark.h>

#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>
#include <string>
#include <vector>

namespace splitfusion {

/// What the message of a row begins with whose input is missing: it is skipped,
/// which is no error.
constexpr char kSkipped[] = "skipped: ";

/// Gathers the rows of all benchmarks and tells them as one table or as JSON.
///
/// Benchmarks are registered under a plain name, their companions under
/// `name/companion`: `name/floor` is the barest loop that moves the same data
/// or does the same arithmetic.
class BenchmarkReport : public benchmark::BenchmarkReporter {
 public:
  /// Says nothing of the machine.
  bool ReportContext(const Context&) override { return true; }
  /// Keeps the times of all repetitions.
  void ReportRuns(const std::vector<Run>& runs) override;

  /// Rows that failed, "name: message".
  const std::set<std::string>& errors() const { return errors_; }

  /// Prints the medians over the repetitions: a line a benchmark with its time
  /// and its floor's, and companions as multiples of its time.
  void PrintTable(std::ostream* out) const;

  /// The same as an object by benchmark: `time` and `floor` (seconds),
  /// `over_floor`; null where there is no floor. `companions`: seconds by name.
  /// `gn_iteration` also has the ratios of the times.
  nlohmann::json ToJson() const;

 private:
  std::map<std::string, std::vector<double>> seconds_;  // By full name.
  std::map<std::string, std::string> skipped_;
  std::set<std::string> errors_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_BENCHMARK_REPORT_H_
