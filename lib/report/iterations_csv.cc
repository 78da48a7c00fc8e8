#include "splitfusion/lib/report/iterations_csv.h"

#include "splitfusion/lib/report/csv_row.h"

namespace splitfusion {

void WriteIterationsHeader(std::ostream& out) {
  out << "frame,surface,round,stage,stride,anneal,iteration,accepted,"
         "cost,cost_change,gradient_max_norm,step_norm,trust_region_radius,"
         "linear_solver_iterations,linear_residual,seconds\n";
}

void WriteIterations(std::ostream& out, const FrameReport& report) {
  for (const SurfaceReport& surface : report.surfaces) {
    int number = 0;
    for (const TrackingRound& round : surface.rounds) {
      for (const SolverIteration& it : round.solver.iterations) {
        CsvRow row;
        row.Add(report.frame).Add(surface.id).Add(number);
        row.Add(round.stage).Add(round.stride).Add(round.anneal);
        row.Add(it.iteration).Add(it.accepted ? 1 : 0).Add(it.cost);
        row.Add(it.cost_change).Add(it.gradient_max_norm).Add(it.step_norm);
        row.Add(it.trust_region_radius).Add(it.linear_solver_iterations);
        row.Add(it.linear_residual).Add(it.seconds);
        out << row.text() << '\n';
      }
      ++number;
    }
  }
}

}  // namespace splitfusion
