#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "splitfusion/pipelines/sequence_run.h"

/// What SequenceRun warns of.

namespace splitfusion {
namespace {

/// Names of the terms of any surface that weigh something.
std::set<std::string> TermsInUse(const SurfaceEnergies& energies) {
  std::set<std::string> names;
  const auto look = [&](const Energy& energy) {
    for (const WeightedTerm& term : energy) {
      if (term.options.weight > 0) names.insert(term.options.name);
    }
  };
  look(energies.all());
  for (const std::string& named : energies.classes()) look(energies.Of(named));
  return names;
}

}  // namespace

/// What a run begins with.
std::string SequenceRun::ExpectedDepth() const {
  const DepthOptions& depth = work_->reader.options().depth;
  std::ostringstream text;
  text << "expected depth from " << depth.min_depth << " to " << depth.max_depth
       << " m (--min_depth, --max_depth, --depth_scale)";
  return text.str();
}

/// Once a run.
void SequenceRun::WarnOfMissingDepth(const Frame& frame) {
  if (warned_of_depth_ || !work_->fusion.surfaces().empty()) return;
  warned_of_depth_ = true;
  Warn("frame " + std::to_string(frame.index) + ", " + frame.stem +
       ": no background to begin with: " + ExpectedDepth() +
       "; passed over until there is");
}

void SequenceRun::WarnOfLostSurfaces(const FrameReport& report) const {
  for (const SurfaceReport& surface : report.surfaces) {
    if (surface.state != TrackState::kLost) continue;
    Warn("frame " + std::to_string(report.frame) + ": surface " +
         std::to_string(surface.id) + " (" + surface.label +
         ") lost: " + surface.reason);
  }
}

/// Once a surface.
void SequenceRun::WarnOfCoarseGraphs(int frame) {
  for (const auto& [id, surface] : work_->fusion.surfaces()) {
    const double planned = surface->planned_node_spacing();
    const double spacing = surface->graph().node_spacing;
    if (spacing <= planned || !coarse_.insert(id).second) continue;
    std::ostringstream text;
    text << "frame " << frame << ": surface " << id << " (" << surface->label()
         << ") has nodes every " << 1000 * spacing << " mm instead of "
         << 1000 * planned
         << " mm, to keep --max_nodes=" << surface->graph_options().max_nodes;
    Warn(text.str());
  }
}

void SequenceRun::WarnOfUnknownClasses() const {
  std::set<std::string> classes;
  for (const auto& [id, surface] : work_->fusion.surfaces()) {
    classes.insert(ClassKey(surface->label()));
  }
  for (const std::string& named : work_->fusion.energies().classes()) {
    if (classes.count(named) > 0) continue;
    Warn("terms of class " + named + " had no effect: there are surfaces of " +
         AnyOf({classes.begin(), classes.end()}));
  }
}

void SequenceRun::HearTerms(const FrameReport& report) {
  for (const SurfaceReport& surface : report.surfaces) {
    for (const TrackingRound& round : surface.rounds) {
      for (const TermCost& term : round.solver.terms) {
        if (term.residual_vectors > 0) heard_terms_.insert(term.term);
      }
    }
  }
}

void SequenceRun::WarnOfSilentTerms() const {
  std::set<std::string> silent = TermsInUse(work_->fusion.energies());
  // Of the default energy a room alone, or known poses, leave some out.
  for (const std::string& term : TermsInUse(
           SurfaceEnergies::Parse(PipelineOptions().terms, BuiltinTerms()))) {
    silent.erase(term);
  }
  for (const std::string& term : heard_terms_) silent.erase(term);
  for (const std::string& term : silent) {
    Warn("term " + term + " had no effect: it added no residuals in any frame");
  }
}

void SequenceRun::WarnOfSkippedFrames() const {
  const std::vector<BadFrame> skipped = work_->reader.skipped();
  if (skipped.empty()) return;
  Warn((skipped.size() == 1 ? "1 frame is left out: "
                            : std::to_string(skipped.size()) +
                                  " frames are left out, the first: ") +
       skipped.front().reason);
}

void SequenceRun::Warn(const std::string& line) const {
  if (hooks_.warn) hooks_.warn(line);
}

}  // namespace splitfusion
