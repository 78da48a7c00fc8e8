// Time of one Gauss-Newton iteration of the energy of one surface (SplitFusion
// Eq. 4-7), the second from rest: 400 nodes, 30,000 point-to-plane residuals
// with Tukey's loss, six nodes each, and ARAP. Rows use all cores; problems are
// built outside of the time taken.
//
//   gn_iteration            of --solver=gn_pcg, trial step included, as the
//                           solver's report times it
//     /floor                sums given Jacobians, conjugate gradients with
//                           block Jacobi to the same tolerance
//     /reference_36         Ceres, CGNR, one autodiff block of 36 a point
//     /ceres_grouped        --solver=ceres --linear_solver=cgnr
//     /custom_term          the distances by a term of the user's own
//   iteration_N_nodes       the same with N nodes and 75 points each
//     /gn_cholesky          of that solver
//     /ceres                of that solver, which factorises

#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "energy_measured.h"

namespace splitfusion {
namespace {

/// The scene with all that the rows measure, made when the first row asks.
const MeasuredEnergy& Measured() {
  static const MeasuredEnergy measured;
  return measured;
}

/// Scenes by their nodes, made when a row asks.
const EnergyScene& SceneOf(int nodes) {
  static std::map<int, EnergyScene> scenes;
  return scenes.try_emplace(nodes, nodes, 75 * nodes).first->second;
}

/// True if floors and library disagree; the row is then an error.
bool Refused(benchmark::State& state) {
  const std::string& disagreement = Measured().disagreement();
  if (!disagreement.empty()) state.SkipWithError(disagreement.c_str());
  return !disagreement.empty();
}

/// The last iteration of a minimisation, as its report times it.
void Iterate(benchmark::State& state, const EnergyScene& scene,
             const SolverOptions& options, bool custom) {
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

void Iteration(benchmark::State& state, const SolverOptions& options,
               bool custom) {
  if (!Refused(state)) Iterate(state, Measured().scene(), options, custom);
}

void Growth(benchmark::State& state, int nodes, const std::string& solver) {
  Iterate(state, SceneOf(nodes), EnergyScene::Options(solver),
          /*custom=*/false);
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

const bool kGrowthIsRegistered = [] {
  for (const int nodes : {100, 1600, 4000}) {
    const std::string row = "iteration_" + std::to_string(nodes) + "_nodes";
    for (const std::string solver : {"gn_pcg", "gn_cholesky", "ceres"}) {
      const std::string name = solver == "gn_pcg" ? row : row + "/" + solver;
      benchmark::RegisterBenchmark(name.c_str(), Growth, nodes, solver)
          ->UseManualTime();
    }
  }
  return true;
}();

}  // namespace
}  // namespace splitfusion
