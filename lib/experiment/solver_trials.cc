#include "splitfusion/lib/experiment/solver_trials.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "splitfusion/lib/base/thread_limit.h"

namespace splitfusion {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
/// Converged so far above the least cost: elsewhere.
constexpr double kOtherMinimum = 1e-4;  // Format.
constexpr double kLeastGap = 1e-12;     // Maths.

/// What is compared with each other: problem and start.
using StartKey = std::pair<std::string, std::string>;

StartKey KeyOf(const SolverTrial& trial) {
  return {trial.problem, trial.start};
}

/// Costs over time: after every iteration, the start first.
struct CostAt {
  double seconds = 0;  ///< Since the call.
  double cost = 0;     ///< Least so far.
};

std::vector<CostAt> History(const SolverReport& report) {
  double in_iterations = 0;
  for (const SolverIteration& it : report.iterations)
    in_iterations += it.seconds;
  // Setting the problem up comes before the first iteration.
  double seconds = std::max(0.0, report.total_seconds - in_iterations);
  std::vector<CostAt> history;
  for (const SolverIteration& it : report.iterations) {
    seconds += it.seconds;
    const double before =
        history.empty() ? report.initial_cost : history.back().cost;
    history.push_back(
        {seconds, it.accepted ? std::min(before, it.cost) : before});
  }
  return history;
}

double Gap(double cost, double start, double best) {
  return start > best ? (cost - best) / (start - best) : 0;
}

double SecondsTo(double gap, const SolverReport& report, double best) {
  for (const CostAt& at : History(report)) {
    if (Gap(at.cost, report.initial_cost, best) <= gap) return at.seconds;
  }
  return kUnknown;
}

std::string StatusOf(const SolverReport& report, double best) {
  if (!report.usable) return "failed";
  if (report.termination != "CONVERGENCE") return "no_convergence";
  const bool elsewhere =
      report.final_cost > best * (1 + kOtherMinimum) &&
      Gap(report.final_cost, report.initial_cost, best) > kSolverGaps.back();
  return elsewhere ? "other_minimum" : "converged";
}

std::map<StartKey, double> LeastCosts(const std::vector<SolverTrial>& trials) {
  std::map<StartKey, double> best;
  for (const SolverTrial& trial : trials) {
    if (!trial.report.usable) continue;
    double& least =
        best.emplace(KeyOf(trial), trial.report.final_cost).first->second;
    least = std::min(least, trial.report.final_cost);
  }
  return best;
}

/// Name of a curve: the setting, with threads where they differ.
std::string CurveName(const SolverTrial& trial, bool with_threads) {
  return with_threads
             ? trial.setting + ", " + std::to_string(trial.threads) + " threads"
             : trial.setting;
}

/// Trials by the curve they belong to, in the order in which these came.
std::vector<std::pair<std::string, std::vector<const SolverTrial*>>> ByCurve(
    const std::vector<SolverTrial>& trials) {
  std::set<int> threads;
  for (const SolverTrial& trial : trials) threads.insert(trial.threads);
  std::vector<std::pair<std::string, std::vector<const SolverTrial*>>> curves;
  for (const SolverTrial& trial : trials) {
    const std::string name = CurveName(trial, threads.size() > 1);
    auto found = std::find_if(curves.begin(), curves.end(),
                              [&](const auto& c) { return c.first == name; });
    if (found == curves.end()) found = curves.insert(found, {name, {}});
    found->second.push_back(&trial);
  }
  return curves;
}

/// Gap of a trial after `place` (seconds or iterations).
using GapAt = std::function<double(const SolverTrial&, double place)>;

std::vector<std::pair<double, double>> MeanGaps(
    const std::vector<const SolverTrial*>& trials,
    const std::vector<double>& places, const GapAt& gap_at) {
  std::vector<std::pair<double, double>> points;
  for (const double place : places) {
    double sum = 0;
    for (const SolverTrial* trial : trials) {
      sum += std::log(std::max(kLeastGap, gap_at(*trial, place)));
    }
    points.emplace_back(place,
                        std::exp(sum / static_cast<double>(trials.size())));
  }
  return points;
}

CurveChart GapChart(const std::vector<SolverTrial>& trials,
                    const std::vector<double>& places, const ChartAxis& x,
                    const GapAt& gap_at) {
  CurveChart chart;
  chart.title = "Relative gap, geometric mean over all problems";
  chart.x = x;
  chart.y = {"(f - f*) / (f0 - f*)", true};
  for (const auto& [name, own] : ByCurve(trials)) {
    chart.curves.push_back({name, MeanGaps(own, places, gap_at)});
  }
  return chart;
}

}  // namespace

SolverTrial RunTrial(const std::string& name, const FrozenProblem& problem,
                     const SolverSetting& setting,
                     const SolverRegistry& solvers, const TrialPlan& plan) {
  SolverTrial trial;
  trial.problem = name;
  trial.setting = setting.name;
  trial.solver = setting.solver;
  trial.preconditioner = setting.preconditioner;
  trial.threads = plan.threads;
  trial.start = plan.start;
  trial.repeat = plan.repeat;
  SolverOptions options = setting.options;
  if (options.solver == "ceres") options.threads = plan.threads;
  DeformationGraph graph = problem.graph;
  SurfaceProblem view = problem.View();
  if (plan.start == "cold") {
    graph.motions = *problem.before;
    view.unknowns.clear();
  }
  view.initial_radius = 0;  // That of the options: this is no round of a run.
  const ThreadLimit limit(plan.threads);
  trial.report = solvers.Make(options.solver, options)->Minimize(view, &graph);
  if (!trial.report.usable) trial.message = trial.report.message;
  return trial;
}

void JudgeTrials(std::vector<SolverTrial>* trials) {
  const std::map<StartKey, double> best = LeastCosts(*trials);
  for (SolverTrial& trial : *trials) {
    const auto least = best.find(KeyOf(trial));
    const double cost =
        least == best.end() ? trial.report.initial_cost : least->second;
    trial.status = StatusOf(trial.report, cost);
    for (std::size_t i = 0; i < kSolverGaps.size(); ++i) {
      trial.seconds_to[i] = trial.report.usable
                                ? SecondsTo(kSolverGaps[i], trial.report, cost)
                                : kUnknown;
    }
  }
}

FileTable TrialsTable(const std::vector<SolverTrial>& trials) {
  FileTable table;
  table.name = "solvers";
  table.columns = {"problem",         "solver",          "preconditioner",
                   "threads",         "start",           "repeat",
                   "status",          "iterations",      "linear_iterations",
                   "initial_cost",    "final_cost",      "seconds",
                   "seconds_to_1e-2", "seconds_to_1e-4", "seconds_to_1e-6"};
  for (const SolverTrial& trial : trials) {
    const SolverReport& report = trial.report;
    int linear = 0;
    for (const SolverIteration& it : report.iterations) {
      linear += it.linear_solver_iterations;
    }
    const int iterations =
        std::max(0, static_cast<int>(report.iterations.size()) - 1);
    table.rows.push_back({trial.problem, trial.solver, trial.preconditioner,
                          trial.threads, trial.start, trial.repeat,
                          trial.status, iterations, linear, report.initial_cost,
                          report.usable ? report.final_cost : kUnknown,
                          report.total_seconds, trial.seconds_to[0],
                          trial.seconds_to[1], trial.seconds_to[2]});
  }
  return table;
}

CurveChart PerformanceProfile(const std::vector<SolverTrial>& trials,
                              std::size_t gap) {
  CurveChart chart;
  char title[64];
  std::snprintf(title, sizeof(title), "Problems solved to a gap of %g",
                kSolverGaps[gap]);
  chart.title = title;
  chart.x = {"time / time of the fastest setting", true};
  chart.y = {"share of problems", false};
  chart.steps = true;
  using Key = std::tuple<std::string, std::string, int>;
  std::map<Key, double> fastest;
  double slowest = 1;
  const auto key = [](const SolverTrial& t) {
    return Key{t.problem, t.start, t.repeat};
  };
  for (const SolverTrial& trial : trials) {
    const double seconds = trial.seconds_to[gap];
    if (std::isnan(seconds)) continue;
    double& least = fastest.emplace(key(trial), seconds).first->second;
    least = std::min(least, seconds);
  }
  for (const auto& [name, own] : ByCurve(trials)) {
    std::vector<double> ratios;
    for (const SolverTrial* trial : own) {
      const double seconds = trial->seconds_to[gap];
      if (std::isnan(seconds)) continue;
      ratios.push_back(seconds / std::max(1e-9, fastest.at(key(*trial))));
      slowest = std::max(slowest, ratios.back());
    }
    std::sort(ratios.begin(), ratios.end());
    Curve curve{name, {{1, 0}}};
    for (std::size_t i = 0; i < ratios.size(); ++i) {
      curve.points.emplace_back(ratios[i], double(i + 1) / double(own.size()));
    }
    chart.curves.push_back(curve);
  }
  // Up to the same end.
  for (Curve& curve : chart.curves) {
    curve.points.emplace_back(slowest, curve.points.back().second);
  }
  return chart;
}

CurveChart GapOverTime(const std::vector<SolverTrial>& trials) {
  const std::map<StartKey, double> best = LeastCosts(trials);
  double last = 1e-3;
  for (const SolverTrial& trial : trials) {
    last = std::max(last, trial.report.total_seconds);
  }
  std::vector<double> places;
  for (double at = 1e-3; at < 1.2 * last; at *= 1.2) places.push_back(at);
  return GapChart(trials, places, {"seconds since the call", true},
                  [&](const SolverTrial& trial, double place) {
                    if (!trial.report.usable) return 1.0;
                    double cost = trial.report.initial_cost;
                    for (const CostAt& at : History(trial.report)) {
                      if (at.seconds <= place) cost = at.cost;
                    }
                    return Gap(cost, trial.report.initial_cost,
                               best.at(KeyOf(trial)));
                  });
}

CurveChart GapOverIterations(const std::vector<SolverTrial>& trials) {
  const std::map<StartKey, double> best = LeastCosts(trials);
  std::size_t last = 1;
  for (const SolverTrial& trial : trials) {
    last = std::max(last, trial.report.iterations.size());
  }
  std::vector<double> places;
  for (std::size_t i = 0; i < last; ++i) places.push_back(double(i));
  return GapChart(
      trials, places, {"iterations", false},
      [&](const SolverTrial& trial, double place) {
        const auto history = History(trial.report);
        const auto least = best.find(KeyOf(trial));
        if (history.empty() || least == best.end()) return 1.0;
        const std::size_t at = std::min(history.size() - 1, std::size_t(place));
        return Gap(history[at].cost, trial.report.initial_cost, least->second);
      });
}

}  // namespace splitfusion
