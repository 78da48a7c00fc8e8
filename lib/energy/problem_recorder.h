#ifndef SPLITFUSION_LIB_ENERGY_PROBLEM_RECORDER_H_
#define SPLITFUSION_LIB_ENERGY_PROBLEM_RECORDER_H_

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "splitfusion/lib/energy/frozen_problem.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// Keeps the problems that solvers get, to be written for sf_solve: of every
/// surface the last one of a frame, and the first one of more than one node, in
/// which priors are annealed and lost parts looked for. Solvers do what they
/// did without it.
class ProblemRecorder : public std::enable_shared_from_this<ProblemRecorder> {
 public:
  /// `every`: frames, >= 1, of which one is recorded.
  explicit ProblemRecorder(int every) : every_(every) {}

  /// The same solvers, recorded by this, which they keep alive.
  SolverRegistry Watch(const SolverRegistry& solvers);

  /// Says which frame is next; forgets what is kept.
  void BeginFrame(int frame);

  /// Receives a problem; `first`: not the last one of its surface.
  using Write = std::function<void(const FrozenProblem&, bool first)>;

  /// Hands over what was kept since BeginFrame(), by id of the surface. Of one
  /// with a problem that cannot be frozen nothing is; `refused` receives its
  /// id and why, one line.
  void EndFrame(const Write& write,
                const std::function<void(int, const std::string&)>& refused);

 private:
  class Watched;

  void Keep(FrozenProblem problem);
  void Refuse(int surface, const std::string& reason);

  const int every_;
  int frame_ = 0;
  bool records_ = false;
  std::mutex mutex_;                       // Guards all below.
  std::map<int, FrozenProblem> problems_;  // By surface: last ones,
  std::map<int, FrozenProblem> first_;     // and first ones.
  std::map<int, std::string> refused_;     // By surface.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_PROBLEM_RECORDER_H_
