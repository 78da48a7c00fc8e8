// Solves frozen problems with many solvers, and compares these.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "interruption.h"
#include "progress_line.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/pending_folder.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/gradient_check.h"
#include "splitfusion/lib/energy/terms_library.h"
#include "splitfusion/lib/experiment/solver_trials.h"
#include "tool_main.h"

DEFINE_string(solvers, "",
              "SOLVER[:CHOICE...],...: as in ceres:cgnr:identity; empty: all.");
DEFINE_string(output, "", "Folder to write.");
DEFINE_bool(overwrite, false, "Replace what sf_solve wrote there before.");
DEFINE_int32(repeat, 1, "Solves of each, for their times.");
DEFINE_string(starts, "warm",
              "warm: where the run's solver started; cold: where the surface "
              "was in the frame before; or both.");
DEFINE_string(threads, "1", "Numbers of threads.");
DEFINE_int32(max_iterations, 200, "Iterations of a solve at most.");
DEFINE_double(max_seconds, 30, "No iteration of a solve begins later.");
DEFINE_double(eta, 0.01, "Accuracy of a step's linear solve (gn_pcg, cgnr).");
DEFINE_int32(linear_iterations, 100,
             "Conjugate gradient iterations of a step at most.");
DEFINE_double(tolerance, 1e-12,
              "Converged when the cost changes by less, relative.");
DEFINE_bool(check_gradients, false,
            "Only compare derivatives with differences of the costs.");
DEFINE_string(terms_library, "", "Libraries with terms of your own: FILE,...");

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kUsage[] =
    "Solves problems that --freeze=N of sf_run or sf_refine wrote with many\n"
    "solvers: "
    "times, iterations and costs in DIR/solvers.csv, figures in DIR/*.svg.\n"
    "  sf_solve RUN/problems/*.h5 --output=DIR [--solvers=gn_pcg,ceres:cgnr]\n"
    "           [--starts=warm,cold] [--repeat=N]\n"
    "  sf_solve RUN/problems/*.h5 --check_gradients\n"
    "See docs/solvers.md.\n";

/// Largest deviation of the start of a replay from the run's, relative.
constexpr double kSameStart = 1e-12;

/// A problem under its name.
struct NamedProblem {
  std::string name;
  FrozenProblem problem;
};

/// @throw OptionError if something stands twice.
void CheckDifferent(const std::string& flag,
                    const std::vector<std::string>& words) {
  std::set<std::string> seen;
  for (const std::string& word : words) {
    CheckOption(seen.insert(word).second, flag, word, "each once");
  }
}

std::vector<std::string> Words(const std::string& flag,
                               const std::string& list) {
  std::vector<std::string> words;
  std::istringstream stream(list);
  for (std::string word; std::getline(stream, word, ',');) {
    words.push_back(word);
  }
  CheckDifferent(flag, words);
  return words;
}

std::vector<int> ThreadsFromFlag() {
  std::vector<int> threads;
  for (const std::string& word : Words("threads", FLAGS_threads)) {
    const bool whole = !word.empty() && word.size() <= 4 &&
                       std::all_of(word.begin(), word.end(),
                                   [](char c) { return c >= '0' && c <= '9'; });
    CheckOption(whole && std::stoi(word) >= 1 && std::stoi(word) <= 1024,
                "threads", FLAGS_threads, "numbers 1..1024");
    threads.push_back(std::stoi(word));
  }
  CheckOption(!threads.empty(), "threads", "''", "numbers 1..1024");
  return threads;
}

std::vector<std::string> StartsFromFlag() {
  const std::vector<std::string> starts = Words("starts", FLAGS_starts);
  const bool known = std::all_of(
      starts.begin(), starts.end(),
      [](const std::string& s) { return s == "warm" || s == "cold"; });
  CheckOption(known && !starts.empty(), "starts", FLAGS_starts,
              "warm, cold or both");
  return starts;
}

std::vector<SolverSetting> SettingsFromFlag(const SolverRegistry& solvers) {
  SolverOptions base;
  base.max_iterations = FLAGS_max_iterations;
  base.function_tolerance = FLAGS_tolerance;
  base.max_seconds = FLAGS_max_seconds;
  CheckOption(FLAGS_max_iterations >= 1, "max_iterations", FLAGS_max_iterations,
              ">= 1");
  CheckOption(FLAGS_eta > 0 && FLAGS_eta < 1, "eta", FLAGS_eta,
              "0..1, not 0, not 1");
  CheckOption(FLAGS_linear_iterations >= 1, "linear_iterations",
              FLAGS_linear_iterations, ">= 1");
  CheckOption(FLAGS_max_seconds > 0, "max_seconds", FLAGS_max_seconds, "> 0");
  CheckOption(FLAGS_tolerance >= 0, "tolerance", FLAGS_tolerance, ">= 0");
  std::vector<SolverSetting> settings;
  std::vector<std::string> ways;
  const std::vector<std::string> names = FLAGS_solvers.empty()
                                             ? BuiltinSolverSettings()
                                             : Words("solvers", FLAGS_solvers);
  for (const std::string& name : names) {
    settings.push_back(ParseSolverSetting(name, base, solvers));
    SolverOptions& options = settings.back().options;
    options.eta = FLAGS_eta;
    options.max_linear_solver_iterations = FLAGS_linear_iterations;
    ways.push_back(settings.back().solver + ":" +
                   settings.back().preconditioner);
  }
  CheckDifferent("solvers", ways);
  return settings;
}

/// Names that differ: of files of several runs with their folders.
std::map<std::string, std::string> NamesOf(
    const std::vector<std::string>& files) {
  std::map<std::string, int> count;
  for (const std::string& file : files) ++count[fs::path(file).stem().string()];
  std::map<std::string, std::string> names;
  for (const std::string& file : files) {
    const std::string stem = fs::path(file).stem().string();
    names[file] = count[stem] == 1 ? stem : file;
  }
  return names;
}

/// Deviation of cost and gradient from those of the run, relative.
double Deviation(const FrozenProblem& problem) {
  const ProblemStart start = EvaluateStart(problem.View(), problem.graph);
  double largest = 0, off = 0;
  for (std::size_t i = 0; i < start.gradient.size(); ++i) {
    const Vector6& own = problem.start.gradient[i];
    largest = std::max(largest, own.cwiseAbs().maxCoeff());
    off = std::max(off, (start.gradient[i] - own).cwiseAbs().maxCoeff());
  }
  for (std::size_t i = 0; i < start.by_unknowns.size(); ++i) {
    const double own = problem.start.by_unknowns[i];
    largest = std::max(largest, std::abs(own));
    off = std::max(off, std::abs(start.by_unknowns[i] - own));
  }
  const double cost = std::abs(start.cost - problem.start.cost);
  const double deviation =
      std::max(largest > 0 ? off / largest : off,
               problem.start.cost > 0 ? cost / problem.start.cost : cost);
  return std::isfinite(start.cost) ? deviation
                                   : std::numeric_limits<double>::infinity();
}

std::vector<NamedProblem> ReadProblems(const std::vector<std::string>& files,
                                       const TermRegistry& terms) {
  CheckOption(!files.empty(), "problems", "none",
              "files of sf_run --freeze or sf_refine --freeze");
  CheckDifferent("problems", files);
  const auto names = NamesOf(files);
  std::vector<NamedProblem> problems;
  double worst = 0;
  for (const std::string& file : files) {
    problems.push_back({names.at(file), ReadFrozenProblem(file, terms)});
    const double deviation = Deviation(problems.back().problem);
    worst = std::max(worst, deviation);
    if (deviation <= kSameStart) continue;
    std::cerr << "sf_solve: warning: " << file
              << ": cost or gradient of the start differ from the run's by "
              << deviation << ": expected at most " << kSameStart
              << " (another version?)\n";
  }
  std::cout << problems.size()
            << (problems.size() == 1 ? " problem; its" : " problems; their")
            << " first costs and gradients "
            << "are the run's, to " << worst << '\n';
  return problems;
}

/// Every plan for one problem.
std::vector<TrialPlan> PlansFor(const NamedProblem& named,
                                const std::vector<std::string>& starts,
                                const std::vector<int>& threads) {
  std::vector<TrialPlan> plans;
  for (const std::string& start : starts) {
    if (start == "cold" && !named.problem.before) {
      std::cerr << "sf_solve: warning: " << named.name
                << ": has no frame before, so no cold start\n";
      continue;
    }
    for (const int count : threads) {
      for (int repeat = 0; repeat < FLAGS_repeat; ++repeat) {
        plans.push_back({start, count, repeat});
      }
    }
  }
  return plans;
}

/// Ceres' line searches warn of every restart.
class QuietCeres {
 public:
  QuietCeres() { FLAGS_minloglevel = google::GLOG_ERROR; }
  ~QuietCeres() { FLAGS_minloglevel = google::GLOG_INFO; }
  QuietCeres(const QuietCeres&) = delete;
  QuietCeres& operator=(const QuietCeres&) = delete;
};

std::vector<SolverTrial> RunTrials(const std::vector<NamedProblem>& problems,
                                   const std::vector<SolverSetting>& settings,
                                   const SolverRegistry& solvers) {
  std::vector<std::pair<const NamedProblem*, TrialPlan>> plans;
  for (const NamedProblem& named : problems) {
    for (const TrialPlan& plan :
         PlansFor(named, StartsFromFlag(), ThreadsFromFlag())) {
      plans.emplace_back(&named, plan);
    }
  }
  std::vector<SolverTrial> trials;
  ProgressLine progress;
  const Stopwatch watch;
  const std::size_t total = plans.size() * settings.size();
  const NamedProblem* warm = nullptr;
  for (const auto& [named, plan] : plans) {
    // Memory that is touched for the first time must not count for whoever
    // comes first.
    if (std::exchange(warm, named) != named) {
      RunTrial(named->name, named->problem, settings.front(), solvers, plan);
    }
    for (const SolverSetting& setting : settings) {
      if (Interrupted()) break;
      {
        const QuietCeres quiet;
        trials.push_back(
            RunTrial(named->name, named->problem, setting, solvers, plan));
      }
      const auto done = static_cast<double>(trials.size());
      progress.Show(static_cast<int>(trials.size()), static_cast<int>(total),
                    "solves",
                    watch.Seconds() * (static_cast<double>(total) / done - 1));
      const std::string& message = trials.back().message;
      if (message.empty()) continue;
      progress.End();
      std::cerr << "sf_solve: " << named->name << ": " << setting.name << ": "
                << message << '\n';
    }
  }
  CheckOption(total > 0, "starts", FLAGS_starts,
              "warm, as no problem has a frame before");
  JudgeTrials(&trials);
  return trials;
}

/// One line a setting: how often it came where, and how long it took.
void PrintTable(const std::vector<SolverTrial>& trials) {
  std::vector<std::string> names;
  std::map<std::string, std::map<std::string, int>> counts;
  std::map<std::string, std::vector<double>> seconds;
  for (const SolverTrial& trial : trials) {
    if (counts.count(trial.setting) == 0) names.push_back(trial.setting);
    ++counts[trial.setting][trial.status];
    if (std::isfinite(trial.seconds_to[1])) {
      seconds[trial.setting].push_back(trial.seconds_to[1]);
    }
  }
  for (const std::string& name : names) {
    std::cout << name << ":";
    for (const auto& [status, count] : counts[name]) {
      std::cout << ' ' << count << ' ' << status;
    }
    std::vector<double>& times = seconds[name];
    if (!times.empty()) {
      std::nth_element(times.begin(), times.begin() + times.size() / 2,
                       times.end());
      std::cout << "; median seconds to a gap of 1e-4: "
                << times[times.size() / 2];
    }
    std::cout << '\n';
  }
}

/// Prints the largest deviation of every term. False if one is too large.
bool CheckAllGradients(const std::vector<NamedProblem>& problems) {
  constexpr double kRight = 1e-4;
  std::map<std::string, GradientError> worst;
  for (const NamedProblem& named : problems) {
    for (const GradientError& error :
         CheckGradients(named.problem.View(), named.problem.graph)) {
      GradientError& sum = worst[error.term];
      sum.relative = std::max(sum.relative, error.relative);
      sum.failed += error.failed;
      sum.residuals += error.residuals;
    }
  }
  bool right = true;
  for (const auto& [term, error] : worst) {
    const bool own = error.relative <= kRight && error.failed == 0;
    std::cout << term << ": derivatives deviate by " << error.relative
              << (error.failed > 0 ? ", cost or slope is no number" : "")
              << (error.residuals == 0 ? " (no residuals: not checked)" : "")
              << (own ? "" : ": expected at most 0.0001") << '\n';
    right = right && own;
  }
  return right;
}

void WriteFigures(const std::vector<SolverTrial>& trials,
                  const fs::path& folder) {
  const auto write = [&](const std::string& name, const CurveChart& chart) {
    WriteFileAtomically(
        (folder / (name + ".svg")).string(),
        [&](std::ostream& out) { out << CurveChartSvg(chart); });
  };
  const std::array<const char*, kSolverGaps.size()> gaps = {"1e-2", "1e-4",
                                                            "1e-6"};
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    write(std::string("profile_") + gaps[i], PerformanceProfile(trials, i));
  }
  write("gap_over_time", GapOverTime(trials));
  write("gap_over_iterations", GapOverIterations(trials));
}

int Run(const std::vector<std::string>& files) {
  CheckOption(!FLAGS_output.empty() || FLAGS_check_gradients, "output", "''",
              "a folder to write");
  CheckOption(FLAGS_repeat >= 1, "repeat", FLAGS_repeat, ">= 1");
  StartsFromFlag();
  ThreadsFromFlag();
  TermRegistry terms = BuiltinTerms();
  LoadTermsLibraries(FLAGS_terms_library, &terms);
  const SolverRegistry solvers = BuiltinSolvers();
  const std::vector<SolverSetting> settings = SettingsFromFlag(solvers);
  if (FLAGS_check_gradients) {
    return CheckAllGradients(ReadProblems(files, terms)) ? kExitDone
                                                         : kExitFailure;
  }
  PendingFolder folder(FLAGS_output, "sf_solve", FLAGS_overwrite);
  CatchInterruption();
  const std::vector<SolverTrial> trials =
      RunTrials(ReadProblems(files, terms), settings, solvers);
  WriteCsv((folder.path() / "solvers.csv").string(), TrialsTable(trials));
  WriteFigures(trials, folder.path());
  folder.Commit();
  PrintTable(trials);
  if (Interrupted()) {
    throw std::runtime_error("interrupted; " + FLAGS_output +
                             " has what was solved before");
  }
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  std::vector<std::string> files;
  return splitfusion::ToolMain(
      argc, argv, splitfusion::kUsage, [&] { return splitfusion::Run(files); },
      "", &files);
}
