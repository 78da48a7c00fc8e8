#include "splitfusion/lib/energy/solution_recorder.h"

#include <utility>

#include "splitfusion/lib/energy/trial_surface.h"

namespace splitfusion {

SurfaceProblem SolvedProblem::View() const {
  SurfaceProblem view = problem.View();
  view.live = live;
  return view;
}

/// A solver whose solutions are kept.
class SolutionRecorder::Watched : public Solver {
 public:
  Watched(std::unique_ptr<Solver> solver,
          std::shared_ptr<SolutionRecorder> recorder)
      : solver_(std::move(solver)), recorder_(std::move(recorder)) {}

  SolverReport Minimize(const SurfaceProblem& problem,
                        DeformationGraph* graph) const override {
    SolverReport report = solver_->Minimize(problem, graph);
    if (recorder_->records_ && report.usable &&
        problem.surface != kTrialSurface) {
      recorder_->Keep(problem, report, *graph);
    }
    return report;
  }

 private:
  std::unique_ptr<Solver> solver_;
  std::shared_ptr<SolutionRecorder> recorder_;
};

SolverRegistry SolutionRecorder::Watch(const SolverRegistry& solvers) {
  SolverRegistry watched("solver");
  for (const std::string& name : solvers.names()) {
    watched.Register(name, [solvers, name, recorder = shared_from_this()](
                               const SolverOptions& options) {
      return std::make_unique<Watched>(solvers.Make(name, options), recorder);
    });
  }
  return watched;
}

void SolutionRecorder::BeginFrame(int frame) {
  records_ = frame % every_ == 0;
  solved_.clear();
}

const SolvedProblem* SolutionRecorder::Find(int surface) const {
  const auto found = solved_.find(surface);
  return found == solved_.end() ? nullptr : &found->second;
}

void SolutionRecorder::Keep(const SurfaceProblem& problem,
                            const SolverReport& report,
                            const DeformationGraph& solution) {
  SolvedProblem solved{CopyProblem(problem, solution), problem.live};
  solved.problem.unknowns = FinalUnknowns(report);
  const std::lock_guard<std::mutex> lock(mutex_);
  solved_.insert_or_assign(problem.surface, std::move(solved));
}

}  // namespace splitfusion
