#include "support/sample_report.h"

namespace splitfusion {
namespace {

SolverReport SampleSolver() {
  SolverReport solver;
  solver.usable = true;
  solver.termination = "CONVERGENCE";
  solver.message = "cost settled";
  solver.initial_cost = 2.5;
  solver.final_cost = 0.125;
  solver.parameters = 6;
  solver.residuals = 1000;
  solver.terms = {{"point_to_plane", 1000, 2.0, 0.1}, {"arap", 32, 0.5, 0.025}};
  SolverIteration start;
  start.cost = 2.5;
  SolverIteration step;
  step.iteration = 1;
  step.cost = 0.125;
  step.cost_change = 2.375;
  step.gradient_max_norm = 1e-3;
  step.step_norm = 0.02;
  step.trust_region_radius = 1e4;
  step.linear_solver_iterations = 7;
  step.linear_residual = 0.005;
  step.seconds = 0.004;
  solver.iterations = {start, step};
  return solver;
}

SurfaceReport SampleSurface(int id, const std::string& label,
                            SurfaceKind kind) {
  SurfaceReport surface;
  surface.id = id;
  surface.label = label;
  surface.kind = kind;
  surface.state = TrackState::kTracked;
  surface.pixels = 5000;
  surface.nodes = kind == SurfaceKind::kRigid ? 1 : 120;
  surface.node_spacing = kind == SurfaceKind::kRigid ? 0 : 0.03;
  surface.vertices = 9000;
  surface.residual_rms = 0.003;
  TrackingRound round;
  round.stage = "rigid";
  round.stride = 2;
  round.anneal = 8;
  round.association.model_points = 1200;
  round.association.accepted = 1000;
  round.association.rejected = {{"distance", Rejection::kMisfit, 200}};
  round.solver = SampleSolver();
  surface.rounds = {round};
  return surface;
}

}  // namespace

FrameReport SampleReport(int frame) {
  FrameReport report;
  report.frame = frame;
  report.timestamp = 100.0 + frame / 30.0;
  report.stem = "stem" + std::to_string(frame);
  report.read_seconds = 0.01;
  report.solve_seconds = 0.2;
  report.total_seconds = 0.5;
  report.decisions = {{"matched", 1, "person", 0.9, 0.8}};
  report.surfaces = {SampleSurface(0, "background", SurfaceKind::kRigid),
                     SampleSurface(1, "teddy bear", SurfaceKind::kNonRigid)};
  return report;
}

}  // namespace splitfusion
