#ifndef SPLITFUSION_LIB_EXPERIMENT_SOLVER_TRIALS_H_
#define SPLITFUSION_LIB_EXPERIMENT_SOLVER_TRIALS_H_

#include <array>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/frozen_problem.h"
#include "splitfusion/lib/experiment/result_files.h"
#include "splitfusion/lib/experiment/solver_setting.h"
#include "splitfusion/lib/page/curve_chart.h"

namespace splitfusion {

/// Relative gaps (f - f*) / (f_0 - f*) to which times are taken (Moré and Wild
/// 2009); f*: least cost that any setting reached from the same start.
constexpr std::array<double, 3> kSolverGaps = {1e-2, 1e-4, 1e-6};  // Format.

/// One solve of one frozen problem.
struct SolverTrial {
  std::string problem;         ///< Name of its file, without extension.
  std::string setting;         ///< SolverSetting::name.
  std::string solver;          ///< SolverSetting::solver.
  std::string preconditioner;  ///< In use.
  int threads = 1;             ///< At most.
  /// "warm": from where the run's solver started; "cold": from where the
  /// surface was in the frame before.
  std::string start;
  int repeat = 0;       ///< From 0.
  SolverReport report;  ///< The solver's own.
  /// "converged", "other_minimum" (converged, but more than 1e-4 above f*,
  /// relative), "no_convergence" or "failed".
  std::string status;
  std::string message;  ///< Of one that failed.
  /// Wall-clock time from the call on until the cost is within kSolverGaps of
  /// f*, seconds; NaN if it never was.
  std::array<double, kSolverGaps.size()> seconds_to{};
};

/// A solver at work on a problem.
struct TrialPlan {
  std::string start = "warm";  ///< As SolverTrial::start.
  int threads = 1;             ///< As SolverTrial::threads.
  int repeat = 0;              ///< As SolverTrial::repeat.
};

/// Solves a problem once. Status and times to gaps are left for Judge().
SolverTrial RunTrial(const std::string& name, const FrozenProblem& problem,
                     const SolverSetting& setting,
                     const SolverRegistry& solvers, const TrialPlan& plan);

/// Fills in what is known only when all trials are there: f*, and with it
/// status and times to gaps.
void JudgeTrials(std::vector<SolverTrial>* trials);

/// `solvers`: one row a trial.
FileTable TrialsTable(const std::vector<SolverTrial>& trials);

/// Performance profile (Dolan and Moré 2002): for every setting the share of
/// problems (starts, repeats) that it solves to kSolverGaps[gap] within so many
/// times the time of the fastest.
CurveChart PerformanceProfile(const std::vector<SolverTrial>& trials,
                              std::size_t gap);

/// Geometric mean over all problems of the relative gap, after so many seconds
/// or iterations; a trial that has ended keeps its last cost. Gaps under 1e-12
/// count as that.
CurveChart GapOverTime(const std::vector<SolverTrial>& trials);
/// The same.
CurveChart GapOverIterations(const std::vector<SolverTrial>& trials);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SOLVER_TRIALS_H_
