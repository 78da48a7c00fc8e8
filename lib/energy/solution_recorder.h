#ifndef SPLITFUSION_LIB_ENERGY_SOLUTION_RECORDER_H_
#define SPLITFUSION_LIB_ENERGY_SOLUTION_RECORDER_H_

#include <map>
#include <memory>
#include <mutex>

#include "splitfusion/lib/energy/frozen_problem.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// The last solve of a surface in a frame, with its solution.
struct SolvedProblem {
  /// Its graph and unknowns are the solution; `start` is empty. Terms that ask
  /// for what is not kept (TermContext) count for nothing.
  FrozenProblem problem;
  /// The live frame of the solve, which is not kept: valid until the next
  /// frame; may be null.
  const LiveView* live = nullptr;

  /// The problem itself; holds as long as this.
  SurfaceProblem View() const;
};

/// Keeps what solvers make of their problems, the last one of every surface of
/// a frame, to be looked at after the frame. Solvers do what they did without
/// it.
class SolutionRecorder : public std::enable_shared_from_this<SolutionRecorder> {
 public:
  /// `every`: frames, >= 1, of which one is recorded.
  explicit SolutionRecorder(int every) : every_(every) {}

  /// The same solvers, recorded by this, which they keep alive.
  SolverRegistry Watch(const SolverRegistry& solvers);

  /// Says which frame is next; forgets what is kept.
  void BeginFrame(int frame);

  /// The last solve of a surface since BeginFrame() whose result was usable;
  /// null if there is none, or the frame is not recorded. Not while solvers
  /// run.
  const SolvedProblem* Find(int surface) const;

 private:
  class Watched;

  void Keep(const SurfaceProblem& problem, const SolverReport& report,
            const DeformationGraph& solution);

  const int every_;
  bool records_ = false;
  std::mutex mutex_;                     // Guards solved_.
  std::map<int, SolvedProblem> solved_;  // By surface.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_SOLUTION_RECORDER_H_
