#include "splitfusion/lib/report/report_json.h"

#include <nlohmann/json.hpp>

#include "splitfusion/lib/report/frame_parts.h"

namespace splitfusion {

using Json = nlohmann::ordered_json;

// By to_json() the library makes values of these types, and of lists of them.

void to_json(Json& json, const AssociationCounts& counts) {
  json = {{"model_points", counts.model_points}, {"accepted", counts.accepted}};
  for (const RejectedPoints& rejected : counts.rejected) {
    json[rejected.reason] = rejected.count;
  }
}

void to_json(Json& json, const TermCost& term) {
  json = {{"term", term.term},
          {"residual_vectors", term.residual_vectors},
          {"initial", term.initial},
          {"final", term.final}};
}

void to_json(Json& json, const UnknownEstimate& unknown) {
  json = {{"term", unknown.term},
          {"name", unknown.name},
          {"unit", unknown.unit},
          {"initial", unknown.initial},
          {"final", unknown.final}};
}

void to_json(Json& json, const SolverReport& solver) {
  json = {{"usable", solver.usable},
          {"termination", solver.termination},
          {"message", solver.message},
          {"initial_cost", solver.initial_cost},
          {"final_cost", solver.final_cost},
          {"parameters", solver.parameters},
          {"residuals", solver.residuals},
          {"iterations", solver.iterations.size()},
          {"terms", solver.terms},
          {"seconds",
           {{"jacobian", solver.jacobian_seconds},
            {"linear_solver", solver.linear_solver_seconds},
            {"total", solver.total_seconds}}}};
  if (!solver.unknowns.empty()) json["unknowns"] = solver.unknowns;
}

void to_json(Json& json, const TrackingRound& round) {
  json = {{"stage", round.stage},           {"stride", round.stride},
          {"anneal", round.anneal},         {"association", round.association},
          {"lost_pairs", round.lost_pairs}, {"solver", round.solver}};
}

void to_json(Json& json, const HoldReport& hold) {
  json = {{"nodes", hold.nodes},
          {"held_by_prior", hold.held_by_prior},
          {"median_sigma", hold.median_sigma}};
}

void to_json(Json& json, const SurfaceReport& surface) {
  json = {{"id", surface.id},
          {"label", surface.label},
          {"kind", ToString(surface.kind)},
          {"state", ToString(surface.state)},
          {"event", surface.event},
          {"settled", surface.settled},
          {"misfit", surface.misfit},
          {"track_points", surface.track_points},
          {"started_parts", surface.started_parts},
          {"refuted_nodes", surface.refuted_nodes},
          {"torn_triangles", surface.torn_triangles},
          {"reason", surface.reason},
          {"pixels", surface.pixels},
          {"exposure", surface.exposure},
          {"nodes", surface.nodes},
          {"node_spacing", surface.node_spacing},
          {"vertices", surface.vertices},
          {"residual_rms", surface.residual_rms},
          {"rounds", surface.rounds},
          {"seconds",
           {{"render", surface.render_seconds},
            {"associate", surface.associate_seconds},
            {"solve", surface.solve_seconds},
            {"fuse", surface.fuse_seconds},
            {"mesh", surface.mesh_seconds}}}};
  if (surface.hold) json["hold"] = *surface.hold;
}

void to_json(Json& json, const SplitDecision& decision) {
  json = {{"action", decision.action},
          {"surface", decision.surface},
          {"class_name", decision.class_name},
          {"score", decision.score},
          {"overlap", decision.overlap}};
}

Json ToJson(const FrameReport& report) {
  Json seconds;
  for (const FramePart& part : kFrameParts) {
    seconds[part.name] = report.*part.seconds;
  }
  seconds["total"] = report.total_seconds;
  return {{"frame", report.frame},         {"timestamp", report.timestamp},
          {"stem", report.stem},           {"seconds", seconds},
          {"decisions", report.decisions}, {"surfaces", report.surfaces}};
}

}  // namespace splitfusion
