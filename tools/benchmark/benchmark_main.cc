// Runs the benchmarks in random order, each some times, and prints one table of
// medians; exit code 1 if a row fails, 2 if an argument is wrong. run.sh --help
// has the arguments; those of Google Benchmark are understood, too.

#include <benchmark/benchmark.h>

#include <filesystem>
#include <iostream>
#include <regex>
#include <set>
#include <sstream>

#include "benchmark_report.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/process_memory.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Gives Google Benchmark its own flags; returns what it does not know.
std::vector<std::string> Initialize(std::vector<std::string> flags) {
  flags.insert(flags.begin(), "sf_benchmark");
  std::vector<char*> argv;
  for (std::string& flag : flags) argv.push_back(flag.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(flags.size());
  benchmark::Initialize(&argc, argv.data());
  return {argv.begin() + 1, argv.begin() + argc};
}

/// Names of all benchmarks and companions.
std::vector<std::string> RegisteredNames() {
  Initialize({"--benchmark_list_tests=true"});
  std::stringstream listing;
  BenchmarkReport reporter;
  reporter.SetOutputStream(&listing);
  benchmark::RunSpecifiedBenchmarks(&reporter, "all");
  Initialize({"--benchmark_list_tests=false"});
  std::vector<std::string> names;
  for (std::string line; std::getline(listing, line);) names.push_back(line);
  return names;
}

/// Regular expression of the benchmarks that the filter selects by their own
/// name or that of a companion: with all their companions.
std::string Selection(const std::string& filter) {
  std::set<std::string> selected;
  try {
    const std::regex expression(filter, std::regex::extended);
    const std::regex settings("/(real_time|manual_time|iterations:.*)$");
    for (const std::string& name : RegisteredNames()) {
      if (std::regex_search(std::regex_replace(name, settings, ""),
                            expression)) {
        selected.insert(name.substr(0, name.find('/')));
      }
    }
  } catch (const std::regex_error&) {
    throw OptionError("--filter", filter, "a regular expression");
  }
  if (selected.empty()) {
    throw OptionError("--filter", filter, "to match a benchmark's name");
  }
  std::string alternatives;
  for (const std::string& name : selected) alternatives += name + "|";
  alternatives.pop_back();
  return "^(" + alternatives + ")(/|$)";
}

/// Says so before anything is run if the file cannot be written.
void CheckWritable(const std::string& file) {
  if (fs::is_directory(file) ||
      !CanMakeFiles(fs::absolute(file).parent_path().string())) {
    throw InputError("--json=" + file + ": cannot be written");
  }
}

int Run(int argc, char** argv) {
  std::string filter, json;
  std::vector<std::string> flags = {
      "--benchmark_enable_random_interleaving=true",
      "--benchmark_repetitions=5", "--benchmark_min_time=0.1"};
  flags.insert(flags.end(), argv + 1, argv + argc);
  for (const std::string& text : Initialize(flags)) {
    const std::string value = text.substr(text.find('=') + 1);
    if (text.rfind("--filter=", 0) == 0) {
      filter = value;
    } else if (text.rfind("--json=", 0) == 0) {
      json = value;
    } else {
      throw InputError(text +
                       ": unknown argument: expected --filter=REGEX, "
                       "--json=FILE or --benchmark_...");
    }
  }
  if (!json.empty()) CheckWritable(json);
  BenchmarkReport report;
  benchmark::RunSpecifiedBenchmarks(&report, Selection(filter));
  report.PrintTable(&std::cout);
  for (const std::string& error : report.errors()) {
    std::cerr << "sf_benchmark: " << error << '\n';
  }
  if (!report.errors().empty()) return 1;
  if (json.empty()) return 0;
  WriteJson(json, report.ToJson(), 2);
  return 0;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  splitfusion::KeepFreedMemory();
  try {
    return splitfusion::Run(argc, argv);
  } catch (const splitfusion::InputError& error) {
    std::cerr << "sf_benchmark: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "sf_benchmark: " << error.what() << '\n';
    return 1;
  }
}
