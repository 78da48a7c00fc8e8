#include "splitfusion/lib/evaluation/depth_agreement.h"

#include <cmath>
#include <map>
#include <opencv2/core.hpp>

#include "splitfusion/lib/evaluation/error_histogram.h"
#include "splitfusion/lib/evaluation/model_view.h"

namespace splitfusion {
namespace {

/// Differences of one surface so far.
struct Tally {
  DepthAgreement agreement;
  ErrorHistogram distances;
};

/// Tallies of surfaces by id.
using Tallies = std::map<int, Tally>;

/// Adds a live pixel of the tally's surface, at which the model shows the
/// surface `shown` (-1 = nothing); both depths in metres.
void AddPixel(float live, float model, int shown, Tally* tally) {
  DepthAgreement& agreement = tally->agreement;
  ++agreement.pixels;
  if (shown == agreement.surface_id) {
    tally->distances.Add(std::abs(model - live));
  } else {
    ++agreement.uncovered;
    agreement.other_surface += shown >= 0;
  }
}

void AddFrame(const RecordedRun& run, const RecordedFrame& frame,
              const std::vector<const AnimatedSurface*>& tracked,
              Tallies* tallies) {
  const cv::Mat_<float> live = ReadLiveDepth(run, frame);
  const cv::Mat_<std::uint16_t> mask = ReadMask(run, frame, live.size());
  const ModelView view = RenderModelView(tracked, frame.index, *run.camera);
  // Of the surfaces that count in this frame.
  std::map<int, Tally*> found;
  for (const AnimatedSurface* surface : tracked) {
    Tally& tally = tallies->at(surface->recorded().id);
    ++tally.agreement.frames;
    found[surface->recorded().id] = &tally;
  }
  for (int v = 0; v < live.rows; ++v) {
    for (int u = 0; u < live.cols; ++u) {
      if (!(live(v, u) > 0)) continue;
      const auto tally = found.find(mask(v, u));
      if (tally == found.end()) continue;
      AddPixel(live(v, u), view.depth(v, u), view.surface(v, u), tally->second);
    }
  }
}

std::vector<const AnimatedSurface*> TrackedIn(
    int frame, const std::vector<AnimatedSurface>& surfaces) {
  std::vector<const AnimatedSurface*> tracked;
  for (const AnimatedSurface& surface : surfaces) {
    if (surface.Tracked(frame)) tracked.push_back(&surface);
  }
  return tracked;
}

}  // namespace

std::vector<DepthAgreement> CompareDepth(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    int every) {
  CheckSource(run);
  Tallies tallies;
  for (const AnimatedSurface& surface : surfaces) {
    const RecordedSurface& recorded = surface.recorded();
    tallies[recorded.id].agreement.surface_id = recorded.id;
    tallies[recorded.id].agreement.surface_label = recorded.label;
  }
  for (std::size_t i = 0; i < run.frames.size(); i += every) {
    const auto tracked = TrackedIn(run.frames[i].index, surfaces);
    if (!tracked.empty()) AddFrame(run, run.frames[i], tracked, &tallies);
  }
  std::vector<DepthAgreement> result;
  for (auto& [id, tally] : tallies) {
    tally.agreement.distances = tally.distances.Statistics();
    result.push_back(tally.agreement);
  }
  return result;
}

}  // namespace splitfusion
