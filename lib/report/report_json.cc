#include "splitfusion/lib/report/report_json.h"

#include <nlohmann/json.hpp>

#include "splitfusion/lib/report/frame_parts.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

Json ToJson(const AssociationCounts& counts) {
  Json json = {{"model_points", counts.model_points},
               {"accepted", counts.accepted}};
  for (const RejectedPoints& rejected : counts.rejected) {
    json[rejected.reason] = rejected.count;
  }
  return json;
}

Json ToJson(const TermCost& term) {
  return {{"term", term.term},
          {"residual_vectors", term.residual_vectors},
          {"initial", term.initial},
          {"final", term.final}};
}

Json ToJson(const SolverReport& solver) {
  Json terms = Json::array();
  for (const TermCost& term : solver.terms) terms.push_back(ToJson(term));
  return {{"usable", solver.usable},
          {"termination", solver.termination},
          {"message", solver.message},
          {"initial_cost", solver.initial_cost},
          {"final_cost", solver.final_cost},
          {"parameters", solver.parameters},
          {"residuals", solver.residuals},
          {"iterations", solver.iterations.size()},
          {"terms", terms},
          {"seconds",
           {{"jacobian", solver.jacobian_seconds},
            {"linear_solver", solver.linear_solver_seconds},
            {"total", solver.total_seconds}}}};
}

Json ToJson(const TrackingRound& round) {
  return {{"stage", round.stage},
          {"stride", round.stride},
          {"anneal", round.anneal},
          {"association", ToJson(round.association)},
          {"solver", ToJson(round.solver)}};
}

Json ToJson(const SurfaceReport& surface) {
  Json rounds = Json::array();
  for (const auto& round : surface.rounds) rounds.push_back(ToJson(round));
  return {{"id", surface.id},
          {"label", surface.label},
          {"kind", ToString(surface.kind)},
          {"state", ToString(surface.state)},
          {"event", surface.event},
          {"reason", surface.reason},
          {"pixels", surface.pixels},
          {"exposure", surface.exposure},
          {"nodes", surface.nodes},
          {"node_spacing", surface.node_spacing},
          {"vertices", surface.vertices},
          {"residual_rms", surface.residual_rms},
          {"rounds", rounds},
          {"seconds",
           {{"render", surface.render_seconds},
            {"associate", surface.associate_seconds},
            {"solve", surface.solve_seconds},
            {"fuse", surface.fuse_seconds},
            {"mesh", surface.mesh_seconds}}}};
}

Json ToJson(const SplitDecision& decision) {
  return {{"action", decision.action},
          {"surface", decision.surface},
          {"class_name", decision.class_name},
          {"score", decision.score},
          {"overlap", decision.overlap}};
}

}  // namespace

Json ToJson(const FrameReport& report) {
  Json seconds;
  for (const FramePart& part : kFrameParts) {
    seconds[part.name] = report.*part.seconds;
  }
  seconds["total"] = report.total_seconds;
  Json decisions = Json::array();
  for (const auto& item : report.decisions) decisions.push_back(ToJson(item));
  Json surfaces = Json::array();
  for (const auto& item : report.surfaces) surfaces.push_back(ToJson(item));
  return {{"frame", report.frame},  {"timestamp", report.timestamp},
          {"stem", report.stem},    {"seconds", seconds},
          {"decisions", decisions}, {"surfaces", surfaces}};
}

}  // namespace splitfusion
