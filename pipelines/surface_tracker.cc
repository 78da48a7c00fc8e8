#include "splitfusion/pipelines/surface_tracker.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "splitfusion/lib/energy/term_state.h"
#include "splitfusion/lib/tracking/agreement.h"
#include "splitfusion/pipelines/part_start.h"

namespace splitfusion {
namespace {

/// A sample as a point of the camera frame under the current warp, carried by
/// one node: for the problem of finding one motion for the whole surface.
ModelSample WarpedSample(ModelSample sample, const WarpField& warp) {
  sample.point = warp.WarpPoint(sample.skinning, sample.point);
  sample.normal = warp.WarpNormal(sample.skinning, sample.normal);
  sample.skinning = Skinning();
  sample.skinning.count = 1;
  sample.skinning.weights[0] = 1;
  return sample;
}

std::vector<ModelSample> WarpedSamples(const std::vector<ModelSample>& samples,
                                       const WarpField& warp) {
  std::vector<ModelSample> warped;
  warped.reserve(samples.size());
  for (const ModelSample& sample : samples) {
    warped.push_back(WarpedSample(sample, warp));
  }
  return warped;
}

/// Root mean square of the point-to-plane distances, metres.
double ResidualRms(const std::vector<Correspondence>& correspondences,
                   const DeformationGraph& graph) {
  const WarpField warp(graph);
  double sum = 0;
  for (const Correspondence& c : correspondences) {
    const double r = c.warped_normal.dot(
        warp.WarpPoint(c.model.skinning, c.model.point) - c.target);
    sum += r * r;
  }
  return correspondences.empty() ? 0 : std::sqrt(sum / correspondences.size());
}

/// Centroid of the warped samples, camera frame; the origin if there are none.
Eigen::Vector3d CentroidOf(const std::vector<ModelSample>& samples,
                           const DeformationGraph& graph) {
  const WarpField warp(graph);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ModelSample& sample : samples) {
    sum += warp.WarpPoint(sample.skinning, sample.point).cast<double>();
  }
  return samples.empty() ? sum : sum / static_cast<double>(samples.size());
}

/// The stage at half its stride as often as a small surface needs.
TrackingStage FittedStage(const TrackingStage& stage, int min_samples,
                          const std::vector<ModelSample>& samples) {
  TrackingStage fitted = stage;
  while (fitted.stride % 2 == 0) {
    int count = 0;
    for (const ModelSample& sample : samples) {
      count += sample.u % fitted.stride == 0 && sample.v % fitted.stride == 0;
    }
    if (count >= min_samples) break;
    fitted.stride /= 2;
  }
  return fitted;
}

/// Radius of a round's trust region: it goes on from the round before, as the
/// rounds of a stage are one minimisation with ever newer correspondences. It
/// does not outgrow the first one: parts with few edges to the rest would
/// swing.
double StartRadius(const std::vector<TrackingRound>& rounds,
                   const std::string& stage, double first) {
  if (rounds.empty() || rounds.back().stage != stage) return first;
  const std::vector<SolverIteration>& steps = rounds.back().solver.iterations;
  return steps.empty() ? first
                       : std::min(first, steps.back().trust_region_radius);
}

/// Values at which a round's solve begins to look for the terms' own unknowns:
/// those of the round before, of whatever stage; in the first round where they
/// begin the frame.
std::vector<double> StartUnknowns(const std::vector<TrackingRound>& rounds,
                                  const Energy& energy,
                                  const TermStates* states) {
  const auto last = std::find_if(
      rounds.rbegin(), rounds.rend(),
      [](const TrackingRound& round) { return round.solver.usable; });
  if (last != rounds.rend()) return FinalUnknowns(last->solver);
  std::vector<double> values;
  for (std::size_t i = 0; states != nullptr && i < energy.size(); ++i) {
    const std::vector<double>* begun = states->Begun(energy, i);
    if (begun != nullptr) {
      values.insert(values.end(), begun->begin(), begun->end());
    }
  }
  return values;
}

/// Whether the last step raised the cost and was not taken: a shorter one may
/// lower it.
bool WasTooLong(const SolverReport& report) {
  return report.iterations.size() > 1 && !report.iterations.back().accepted;
}

/// Point tracks but for those of parts which are elsewhere than their part
/// started: flow that is wrong comes back, too.
std::vector<TrackedPoint> TracksThatAgree(
    const std::vector<TrackedPoint>& tracks, const PartStart& start,
    const DeformationGraph& graph, const DepthNoise& noise) {
  const WarpField warp(graph);
  std::vector<TrackedPoint> agreeing;
  for (const TrackedPoint& track : tracks) {
    const Skinning& skinning = track.model.skinning;
    float carried = 0;
    for (int k = 0; k < skinning.count; ++k) {
      if (start.carried[skinning.nodes[k]]) carried += skinning.weights[k];
    }
    const float off =
        (warp.WarpPoint(skinning, track.model.point) - track.target).norm();
    if (carried <= 0.5f ||
        off <= kAgreeingDistance + 2 * noise.Sigma(track.target.z())) {
      agreeing.push_back(track);
    }
  }
  return agreeing;
}

int TotalRounds(const std::vector<TrackingStage>& stages) {
  int rounds = 0;
  for (const TrackingStage& stage : stages) rounds += stage.rounds;
  return rounds;
}

double Degrees(double radians) { return radians * 180 / kPi<double>; }

}  // namespace

SurfaceTracker::SurfaceTracker(TrackerOptions options,
                               const SolverOptions& solver,
                               SurfaceEnergies energies,
                               AssociationRegistry associations,
                               const SolverRegistry& solvers)
    : options_(std::move(options)),
      rigid_stages_(options_.RigidStages()),
      non_rigid_stages_(options_.NonRigidStages()),
      associations_(std::move(associations)),
      initial_radius_(solver.initial_radius),
      energies_(std::move(energies)) {
  options_.Check();
  solver.Check();
  energies_.Check();
  associations_.Check(options_.association);
  solver_ = solvers.Make(solver.solver, solver);
}

bool SurfaceTracker::Track(const std::vector<ModelSample>& samples,
                           const std::vector<TrackedPoint>& tracks,
                           const LiveView& live, std::uint16_t surface,
                           const Rigid3d& still, DeformationGraph* graph,
                           SurfaceReport* report, const TermContext& context,
                           const std::vector<PointMotion>& motions) const {
  const std::unique_ptr<Associator> associator =
      associations_.Make(options_.association, live, surface);
  const Energy& energy = context.surface == nullptr
                             ? energies_.all()
                             : energies_.Of(context.surface->class_name);
  const Target target{live,   surface, *associator, tracks,
                      energy, context, motions};
  DeformationGraph predicted = *graph;
  DeformationGraph stayed = predicted;
  Rigid3d back = still;
  ApplyRigidMotion(still, &stayed);
  if (Misfit(samples, target, predicted) >
      options_.velocity_gain * Misfit(samples, target, stayed)) {
    predicted = stayed;
    back = Rigid3d::Identity();
  }
  const bool tracked =
      TrackFrom(predicted, back, samples, target, graph, report);
  if (!tracked) *graph = predicted;
  return tracked;
}

double SurfaceTracker::Misfit(const std::vector<ModelSample>& samples,
                              const Target& target,
                              const DeformationGraph& graph) const {
  const TrackingStage stage =
      FittedStage(rigid_stages_.front(), options_.min_samples / 4, samples);
  const WarpField warp(graph);
  const Association association =
      target.associator.Associate(samples, warp, stage.stride, stage.gates);
  const AssociationCounts& counts = association.counts;
  int compared = counts.accepted + counts.Count(Rejection::kMisfit);
  // The room is still there behind what moves before it.
  if (target.surface != 0) compared = counts.model_points;
  if (compared == 0) return 2;  // Nothing of it fits anywhere.
  // Truncated; a sample that fits nowhere counts 1 for each.
  double sum = 2.0 * counts.Count(Rejection::kMisfit);
  if (target.surface != 0) {
    sum += 2.0 * (counts.Count(Rejection::kAbsent) +
                  counts.Count(Rejection::kOccluded));
  }
  for (const Correspondence& c : association.correspondences) {
    const double distance =
        c.warped_normal.dot(warp.WarpPoint(c.model.skinning, c.model.point) -
                            c.target) *
        std::sqrt(c.weight) / kAgreeingDistance;
    const double difference = c.intensity_difference / kAgreeingGrey;
    sum += std::min(1.0, distance * distance) +
           std::min(1.0, difference * difference);
  }
  return sum / compared;
}

bool SurfaceTracker::TrackFrom(const DeformationGraph& start,
                               const Rigid3d& back,
                               const std::vector<ModelSample>& samples,
                               const Target& target, DeformationGraph* graph,
                               SurfaceReport* report) const {
  *graph = start;
  TrackRigid(samples, target, back, graph, report);
  // The turn of a body far away must not count as a way travelled.
  const Eigen::Vector3d pivot = target.surface == 0
                                    ? Eigen::Vector3d::Zero().eval()
                                    : CentroidOf(samples, start);
  Rigid3d motion = MeanRigidMotion(*graph) * MeanRigidMotion(start).inverse();
  motion.translation() = motion * pivot - pivot;
  report->reason = ReasonForLoss(motion, *report);
  if (report->reason.empty() && !graph->rigid()) {
    DeformationGraph before = start;
    ApplyRigidMotion(back, &before);
    const std::vector<TrackedPoint> tracks =
        StartParts(samples, target, &before, graph, report);
    const Target started{target.live,   target.surface, target.associator,
                         tracks,        target.energy,  target.context,
                         target.motions};
    TrackNonRigid(samples, started, before.motions, graph, report);
    report->reason = ReasonForLoss(motion, *report);
    if (report->reason.empty() && target.surface != 0) {
      report->reason = ReasonForMisfit(*report);
    }
  }
  report->misfit = Misfit(samples, target, *graph);
  return report->reason.empty();
}

std::vector<TrackedPoint> SurfaceTracker::StartParts(
    const std::vector<ModelSample>& samples, const Target& target,
    DeformationGraph* before, DeformationGraph* graph,
    SurfaceReport* report) const {
  if (options_.part_start.parts.count == 0) return target.tracks;
  const Stopwatch stopwatch;
  const PartStarter::Misfit misfit = [&](const std::vector<ModelSample>& some,
                                         const DeformationGraph& there) {
    return Misfit(some, target, there);
  };
  const PartStart start =
      PartStarter(options_.part_start, *solver_)
          .Start({samples, target.motions, target.live.camera, *before, misfit},
                 graph);
  report->started_parts = start.parts;
  std::vector<TrackedPoint> tracks = target.tracks;
  if (start.parts > 0) {
    *before = *graph;
    tracks = TracksThatAgree(tracks, start, *graph, target.live.camera.noise);
  }
  report->associate_seconds += stopwatch.Seconds();
  return tracks;
}

void SurfaceTracker::TrackRigid(const std::vector<ModelSample>& samples,
                                const Target& target, const Rigid3d& back,
                                DeformationGraph* graph,
                                SurfaceReport* report) const {
  const WarpField warp(*graph);
  const std::vector<ModelSample> warped = WarpedSamples(samples, warp);
  std::vector<TrackedPoint> tracks = target.tracks;
  for (TrackedPoint& point : tracks) {
    point.model = WarpedSample(point.model, warp);
  }
  Target rigid{target.live,   target.surface, target.associator, tracks,
               target.energy, target.context, target.motions};
  rigid.context.surface_graph = graph;
  std::optional<SurfaceHistory> history;
  if (target.context.history != nullptr) {
    history.emplace(target.context.history->InRigidRounds(*graph));
    rigid.context.history = &*history;
  }
  DeformationGraph motion = MakeRigidGraph(Rigid3d::Identity());
  const std::vector<NodeMotion> before = MakeRigidGraph(back).motions;
  const std::vector<TrackingStage> stages = RigidStagesOf(*graph);
  RoundFacts facts;
  facts.rounds = TotalRounds(stages);
  report->settled = false;
  for (const TrackingStage& stage : stages) {
    const TrackingStage fitted =
        FittedStage(stage, options_.min_samples, samples);
    const int end = facts.round + stage.rounds;
    while (facts.round < end) {
      const bool settled =
          RunRound(warped, rigid, fitted, facts, 1.0, before, &motion, report);
      ++facts.round;
      report->settled |= settled;
      if (settled) break;
    }
    ++facts.stage;
  }
  ApplyRigidMotion(MeanRigidMotion(motion), graph);
}

std::vector<TrackingStage> SurfaceTracker::RigidStagesOf(
    const DeformationGraph& graph) const {
  std::vector<TrackingStage> stages;
  for (const TrackingStage& stage : rigid_stages_) {
    // A rigid stage of a non-rigid surface only brings it near.
    if (!graph.rigid() && stage.stride < non_rigid_stages_.front().stride) {
      break;
    }
    stages.push_back(stage);
  }
  return stages;
}

void SurfaceTracker::TrackNonRigid(const std::vector<ModelSample>& samples,
                                   const Target& target,
                                   const std::vector<NodeMotion>& before,
                                   DeformationGraph* graph,
                                   SurfaceReport* report) const {
  RoundFacts facts;
  facts.rigid = false;
  facts.rounds = TotalRounds(non_rigid_stages_);
  for (const TrackingStage& stage : non_rigid_stages_) {
    const TrackingStage fitted =
        FittedStage(stage, options_.min_samples, samples);
    for (int round = 0; round < stage.rounds; ++round, ++facts.round) {
      const double progress =
          facts.rounds > 1 ? facts.round / (facts.rounds - 1.0) : 1.0;
      const double factor = std::pow(options_.prior_anneal, 1 - progress);
      const bool settled = RunRound(samples, target, fitted, facts, factor,
                                    before, graph, report);
      if (settled && progress >= 1) return;
    }
    ++facts.stage;
  }
}

bool SurfaceTracker::RunRound(const std::vector<ModelSample>& samples,
                              const Target& target, const TrackingStage& stage,
                              const RoundFacts& facts, double anneal,
                              const std::vector<NodeMotion>& before,
                              DeformationGraph* graph,
                              SurfaceReport* report) const {
  Stopwatch stopwatch;
  TrackingRound round;
  round.stage = facts.rigid ? "rigid" : "non_rigid";
  round.stride = stage.stride;
  round.anneal = anneal;
  const Association association = target.associator.Associate(
      samples, WarpField(*graph), stage.stride, stage.gates);
  round.association = association.counts;
  round.lost_pairs = static_cast<int>(association.lost.size());
  report->associate_seconds += stopwatch.Restart();
  bool settled = true;
  if (!association.correspondences.empty()) {
    TermContext context = target.context;
    context.samples = &samples;
    if (!facts.rigid) context.surface_graph = graph;
    context.round = facts;
    context.round.stride = stage.stride;
    round.solver = solver_->Minimize(
        {target.energy, association.correspondences, target.live.camera,
         &target.live, &before, anneal,
         options_.keep_radius
             ? StartRadius(report->rounds, round.stage, initial_radius_)
             : initial_radius_,
         &association.lost, &target.tracks, target.surface, context,
         StartUnknowns(report->rounds, target.energy, context.states)},
        graph);
    report->residual_rms = ResidualRms(association.correspondences, *graph);
    settled = !round.solver.usable ||
              (!WasTooLong(round.solver) &&
               round.solver.initial_cost - round.solver.final_cost <
                   options_.settled * round.solver.initial_cost);
  }
  report->solve_seconds += stopwatch.Restart();
  report->rounds.push_back(std::move(round));
  return settled;
}

std::string SurfaceTracker::ReasonForLoss(const Rigid3d& motion,
                                          const SurfaceReport& report) const {
  if (report.rounds.empty()) return "no model in view";
  const TrackingRound& last = report.rounds.back();
  const AssociationCounts& counts = last.association;
  if (counts.accepted < options_.min_correspondences) {
    return "only " + std::to_string(counts.accepted) +
           " correspondences at stride " + std::to_string(last.stride);
  }
  const int comparable = counts.accepted + counts.Count(Rejection::kMisfit);
  if (counts.accepted < options_.min_accepted * comparable) {
    return "only " + std::to_string(counts.accepted) + " of " +
           std::to_string(comparable) + " model points fit the depth";
  }
  if (!last.solver.usable) return "solver: " + last.solver.message;
  const double translation = motion.translation().norm();
  if (translation > options_.max_translation) {
    return "moved " + std::to_string(translation) + " m from its start";
  }
  const double rotation = RotationAngle(motion.linear());
  if (rotation > options_.max_rotation) {
    return "turned " + std::to_string(Degrees(rotation)) +
           " degrees from its start";
  }
  return "";
}

std::string SurfaceTracker::ReasonForMisfit(const SurfaceReport& report) const {
  const AssociationCounts& counts = report.rounds.back().association;
  const int expected = counts.accepted + counts.Count(Rejection::kMisfit) +
                       counts.Count(Rejection::kAbsent);
  if (counts.accepted >= options_.min_fit * expected) return "";
  return "only " + std::to_string(counts.accepted) + " of " +
         std::to_string(expected) + " model points in view lie on it";
}

}  // namespace splitfusion
