// One Gauss-Newton iteration (SplitFusion Eq. 7) against graph nodes and
// against correspondences, on the scene of the energy benchmarks.

#include <functional>
#include <string>
#include <utility>

#include "energy_scene.h"
#include "growth_curves.h"

namespace splitfusion {
namespace {

/// Every value of --solver as the flag alone gives it.
std::vector<std::pair<std::string, SolverOptions>> Solvers() {
  std::vector<std::pair<std::string, SolverOptions>> solvers;
  for (const std::string& name : BuiltinSolvers().names()) {
    solvers.emplace_back(name, EnergyScene::Options(name));
  }
  return solvers;
}

/// Rows of one scene: seconds and linear iterations of the second iteration
/// from rest, as the solver's report has them.
void AddSolverRows(const EnergyScene& scene, int repetitions, int x,
                   GrowthTable* table) {
  const Energy energy = EnergyScene::MakeEnergy(/*custom=*/false);
  for (const auto& [name, options] : Solvers()) {
    SolverIteration last;
    const double seconds = Fastest(repetitions, [&, &options = options] {
      DeformationGraph graph = scene.graph;
      last = Minimize(scene.Problem(energy), options, &graph).iterations.back();
      return last.seconds;
    });
    table->rows.push_back(
        {GrowthLabel(x),
         name,
         {seconds, static_cast<double>(last.linear_solver_iterations)}});
  }
}

}  // namespace

GrowthTable NodesCurve(const GrowthSizes& sizes) {
  GrowthTable table;
  table.columns = {"nodes", "series", "seconds", "linear_iterations"};
  for (const int nodes : sizes.nodes) {
    const EnergyScene scene(nodes, nodes * sizes.points_per_node);
    AddSolverRows(scene, sizes.repetitions, nodes, &table);
  }
  return table;
}

GrowthTable CorrespondencesCurve(const GrowthSizes& sizes) {
  GrowthTable table;
  table.columns = {"correspondences", "series", "seconds", "linear_iterations"};
  for (const int points : sizes.points) {
    const EnergyScene scene(sizes.fixed_nodes, points);
    AddSolverRows(scene, sizes.repetitions, points, &table);
  }
  return table;
}

}  // namespace splitfusion
