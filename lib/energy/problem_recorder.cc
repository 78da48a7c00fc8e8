#include "splitfusion/lib/energy/problem_recorder.h"

#include <optional>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/trial_surface.h"

namespace splitfusion {

/// A solver whose problems are kept.
class ProblemRecorder::Watched : public Solver {
 public:
  Watched(std::string name, std::unique_ptr<Solver> solver,
          std::shared_ptr<ProblemRecorder> recorder)
      : name_(std::move(name)),
        solver_(std::move(solver)),
        recorder_(std::move(recorder)) {}

  SolverReport Minimize(const SurfaceProblem& problem,
                        DeformationGraph* graph) const override {
    if (!recorder_->records_ || problem.surface == kTrialSurface) {
      return solver_->Minimize(problem, graph);
    }
    std::optional<FrozenProblem> frozen;
    try {
      frozen = Freeze(problem, *graph);
    } catch (const InputError& error) {
      recorder_->Refuse(problem.surface, error.what());
    }
    SolverReport report = solver_->Minimize(problem, graph);
    if (frozen) {
      frozen->solver = name_;
      frozen->final_cost = report.final_cost;
      recorder_->Keep(std::move(*frozen));
    }
    return report;
  }

 private:
  std::string name_;
  std::unique_ptr<Solver> solver_;
  std::shared_ptr<ProblemRecorder> recorder_;
};

SolverRegistry ProblemRecorder::Watch(const SolverRegistry& solvers) {
  SolverRegistry watched("solver");
  for (const std::string& name : solvers.names()) {
    watched.Register(name, [solvers, name, recorder = shared_from_this()](
                               const SolverOptions& options) {
      return std::make_unique<Watched>(name, solvers.Make(name, options),
                                       recorder);
    });
  }
  return watched;
}

void ProblemRecorder::BeginFrame(int frame) {
  frame_ = frame;
  records_ = frame % every_ == 0;
  problems_.clear();
  first_.clear();
  refused_.clear();
}

void ProblemRecorder::EndFrame(
    const Write& write,
    const std::function<void(int, const std::string&)>& refused) {
  // Terms may be absent in some rounds: what is left is not the last problem.
  for (const auto& [surface, reason] : refused_) {
    first_.erase(surface);
    problems_.erase(surface);
  }
  for (const auto& [surface, problem] : first_) write(problem, true);
  for (const auto& [surface, problem] : problems_) write(problem, false);
  for (const auto& [surface, reason] : refused_) refused(surface, reason);
}

void ProblemRecorder::Keep(FrozenProblem problem) {
  problem.frame = frame_;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!problem.graph.rigid()) first_.emplace(problem.surface, problem);
  problems_.insert_or_assign(problem.surface, std::move(problem));
}

void ProblemRecorder::Refuse(int surface, const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  refused_[surface] = reason;
}

}  // namespace splitfusion
