// Time of the energy of one surface (SplitFusion Eq. 4-7): 400 nodes, 30,000
// point-to-plane residuals with Tukey's loss, six nodes each, and ARAP. All
// rows are of the same Gauss-Newton iteration, the second from rest, and use
// all cores; problems are built outside of the time taken.
//
//   energy_evaluation       residuals, Jacobians, J^T J and J^T r
//     /floor                sums given Jacobians to J^T J and J^T r
//   linear_solve            conjugate gradients to the default tolerance
//     /floor                as many products with the matrix
//   gn_iteration            one iteration of --solver=gn_pcg, trial step
//                           included, as the solver's report times it
//     /floor                sums given Jacobians, conjugate gradients with
//     block
//                           Jacobi to the same tolerance
//     /reference_36         Ceres, CGNR, one autodiff block of 36 a point
//     /ceres_grouped        --solver=ceres --linear_solver=cgnr
//     /custom_term          the distances by a term of the user's own
//   gn_cholesky_iteration   the same of --solver=gn_cholesky

#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "energy_measured.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/block_problem.h"

namespace splitfusion {
namespace {

/// The scene with all that the rows measure, made when the first row asks.
const MeasuredEnergy& Measured() {
  static const MeasuredEnergy measured;
  return measured;
}

/// True if floors and library disagree; the row is then an error.
bool Refused(benchmark::State& state) {
  const std::string& disagreement = Measured().disagreement();
  if (!disagreement.empty()) state.SkipWithError(disagreement.c_str());
  return !disagreement.empty();
}

void EnergyEvaluation(benchmark::State& state) {
  if (Refused(state)) return;
  const MeasuredEnergy& measured = Measured();
  const Energy energy = EnergyScene::MakeEnergy(/*custom=*/false);
  const SurfaceProblem problem = measured.scene().Problem(energy);
  BlockProblem blocks(problem, measured.scene().graph);
  SymmetricBlockMatrix matrix = blocks.MakeMatrix();
  std::vector<Vector6> gradient;
  for (auto _ : state) {
    blocks.Evaluate(measured.system().twists, /*with_jacobians=*/true);
    blocks.Assemble(&matrix, &gradient);
  }
}

void EnergyEvaluationFloor(benchmark::State& state) {
  if (Refused(state)) return;
  EnergyFloor floor = Measured().floor();
  for (auto _ : state) floor.Assemble();
}

/// Solves the linear system of the last iteration as gn_pcg does by default.
class DefaultSolve {
 public:
  DefaultSolve()
      : system_(Measured().system()),
        options_(EnergyScene::Options("gn_pcg")),
        solver_(MakePcgSolver(options_, Measured().scene().graph)),
        right_(system_.gradient) {
    for (Vector6& v : right_) v = -v;
  }

  /// Returns the number of iterations.
  int Run() {
    return solver_->Solve(system_.damped, right_, &step_).iterations;
  }

 private:
  const MeasuredSystem& system_;
  const SolverOptions options_;
  const std::unique_ptr<LinearSolver> solver_;
  std::vector<Vector6> right_, step_;
};

void LinearSolve(benchmark::State& state) {
  if (Refused(state)) return;
  DefaultSolve solve;
  for (auto _ : state) solve.Run();
}

void LinearSolveFloor(benchmark::State& state) {
  if (Refused(state)) return;
  const int iterations = DefaultSolve().Run();
  EnergyFloor floor = Measured().floor();
  for (auto _ : state) floor.Multiply(iterations);
}

/// The last iteration of a minimisation, as its report times it.
void Iteration(benchmark::State& state, const SolverOptions& options,
               bool custom) {
  if (Refused(state)) return;
  const EnergyScene& scene = Measured().scene();
  const Energy energy = EnergyScene::MakeEnergy(custom);
  for (auto _ : state) {
    DeformationGraph graph = scene.graph;
    const SolverReport report =
        Minimize(scene.Problem(energy), options, &graph);
    if (report.iterations.back().iteration != EnergyScene::kIterations) {
      state.SkipWithError("the solver stopped early");
      return;
    }
    state.SetIterationTime(report.iterations.back().seconds);
  }
}

void GnIterationFloor(benchmark::State& state) {
  if (Refused(state)) return;
  EnergyFloor floor = Measured().floor();
  for (auto _ : state) Measured().RunFloor(&floor);
}

void Reference36(benchmark::State& state) {
  if (Refused(state)) return;
  PlainProblem problem(Measured().scene());
  for (auto _ : state) state.SetIterationTime(problem.Iterate(nullptr));
}

BENCHMARK(EnergyEvaluation)->Name("energy_evaluation")->UseRealTime();
BENCHMARK(EnergyEvaluationFloor)
    ->Name("energy_evaluation/floor")
    ->UseRealTime();
BENCHMARK(LinearSolve)->Name("linear_solve")->UseRealTime();
BENCHMARK(LinearSolveFloor)->Name("linear_solve/floor")->UseRealTime();
BENCHMARK_CAPTURE(Iteration, gn_pcg, EnergyScene::Options("gn_pcg"), false)
    ->Name("gn_iteration")
    ->UseManualTime();
BENCHMARK(GnIterationFloor)->Name("gn_iteration/floor")->UseRealTime();
BENCHMARK(Reference36)->Name("gn_iteration/reference_36")->UseManualTime();
BENCHMARK_CAPTURE(Iteration, ceres, EnergyScene::CeresOptions(), false)
    ->Name("gn_iteration/ceres_grouped")
    ->UseManualTime();
BENCHMARK_CAPTURE(Iteration, custom, EnergyScene::Options("gn_pcg"), true)
    ->Name("gn_iteration/custom_term")
    ->UseManualTime();
BENCHMARK_CAPTURE(Iteration, cholesky, EnergyScene::Options("gn_cholesky"),
                  false)
    ->Name("gn_cholesky_iteration")
    ->UseManualTime();

}  // namespace
}  // namespace splitfusion
