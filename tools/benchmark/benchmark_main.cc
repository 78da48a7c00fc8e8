// Runs the benchmarks in random order, each some times, and prints one table of
// medians; exit code 1 if a row fails, 2 if an argument is wrong. run.sh --help
// has the arguments.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "benchmark_report.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/freed_memory.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Arguments by name, with their defaults.
using Arguments = std::map<std::string, std::string>;

Arguments ParseArguments(int argc, char** argv) {
  Arguments arguments = {
      {"filter", ""}, {"json", ""}, {"repetitions", "5"}, {"min_time", "0.1"}};
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    const std::size_t equals = text.find('=');
    const bool is_flag = text.rfind("--", 0) == 0 && equals < text.size();
    const auto argument =
        arguments.find(is_flag ? text.substr(2, equals - 2) : "");
    if (argument == arguments.end()) {
      throw InputError(text +
                       ": unknown argument: expected --filter=REGEX, "
                       "--json=FILE, --repetitions=N or "
                       "--min_time=SECONDS");
    }
    argument->second = text.substr(equals + 1);
  }
  return arguments;
}

/// The number that an argument gives.
///
/// @throw InputError unless it is one of `least` or more.
double Number(const Arguments& arguments, const std::string& name,
              double least) {
  std::istringstream text(arguments.at(name));
  double value = 0;
  const bool whole = text >> value && text.peek() == EOF;
  CheckOption(whole && value >= least, "--" + name, arguments.at(name),
              "a number from " + std::to_string(least));
  return value;
}

/// Settings of Google Benchmark, by its own flags.
void Configure(std::vector<std::string> flags) {
  flags.insert(flags.begin(), "sf_benchmark");
  std::vector<char*> argv;
  for (std::string& flag : flags) argv.push_back(flag.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(flags.size());
  benchmark::Initialize(&argc, argv.data());
  if (argc > 1) throw InputError(std::string(argv[1]) + ": not understood");
}

/// Names of all benchmarks and companions.
std::vector<std::string> RegisteredNames() {
  Configure({"--benchmark_list_tests=true"});
  std::ostringstream listing;
  BenchmarkReport reporter;
  reporter.SetOutputStream(&listing);
  benchmark::RunSpecifiedBenchmarks(&reporter, "all");
  Configure({"--benchmark_list_tests=false"});
  std::vector<std::string> names;
  std::istringstream lines(listing.str());
  for (std::string line; std::getline(lines, line);) names.push_back(line);
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
  for (const std::string& name : selected) {
    alternatives += (alternatives.empty() ? "" : "|") + name;
  }
  return "^(" + alternatives + ")(/|$)";
}

/// Says so before anything is run if the file cannot be written.
void CheckWritable(const std::string& file) {
  if (fs::is_directory(file) ||
      !CanMakeFiles(fs::absolute(file).parent_path().string())) {
    throw InputError("--json=" + file + ": cannot be written");
  }
}

int Run(const Arguments& arguments) {
  const std::string& json = arguments.at("json");
  if (!json.empty()) CheckWritable(json);
  Number(arguments, "repetitions", 1);
  Number(arguments, "min_time", 1e-3);
  const std::string selection = Selection(arguments.at("filter"));
  Configure({"--benchmark_enable_random_interleaving=true",
             "--benchmark_repetitions=" + arguments.at("repetitions"),
             "--benchmark_min_time=" + arguments.at("min_time")});
  BenchmarkReport report;
  benchmark::RunSpecifiedBenchmarks(&report, selection);
  report.PrintTable(&std::cout);
  for (const std::string& error : report.errors()) {
    std::cerr << "sf_benchmark: " << error << '\n';
  }
  if (!report.errors().empty()) return 1;
  if (json.empty()) return 0;
  WriteFileAtomically(
      json, [&](std::ostream& out) { out << report.ToJson().dump(2) << '\n'; });
  return 0;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  splitfusion::KeepFreedMemory();
  try {
    return splitfusion::Run(splitfusion::ParseArguments(argc, argv));
  } catch (const splitfusion::InputError& error) {
    std::cerr << "sf_benchmark: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "sf_benchmark: " << error.what() << '\n';
    return 1;
  }
}
