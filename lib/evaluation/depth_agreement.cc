#include "splitfusion/lib/evaluation/depth_agreement.h"

#include <cmath>
#include <map>
#include <opencv2/core.hpp>

#include "splitfusion/lib/evaluation/error_histogram.h"
#include "splitfusion/lib/evaluation/live_images.h"
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

/// The surfaces that were tracked in a frame.
std::vector<const AnimatedSurface*> TrackedIn(
    int frame, const std::vector<AnimatedSurface>& surfaces) {
  std::vector<const AnimatedSurface*> tracked;
  for (const AnimatedSurface& surface : surfaces) {
    if (surface.Tracked(frame)) tracked.push_back(&surface);
  }
  return tracked;
}

/// Adds frames to the tallies.
class Comparer {
 public:
  Comparer(const LiveImages& live, const std::vector<AnimatedSurface>& surfaces,
           int plain_view_pixels)
      : live_(live),
        surfaces_(surfaces),
        plain_view_pixels_(plain_view_pixels) {
    for (const AnimatedSurface& surface : surfaces) {
      const RecordedSurface& recorded = surface.recorded();
      tallies_[recorded.id].agreement.surface_id = recorded.id;
      tallies_[recorded.id].agreement.surface_label = recorded.label;
    }
  }

  void Add(const RecordedFrame& frame) {
    const auto tracked = TrackedIn(frame.index, surfaces_);
    if (tracked.empty()) return;
    const cv::Mat_<float> depth = live_.FilteredDepth(frame);
    const cv::Mat_<std::uint16_t> mask = live_.Mask(frame);
    const ModelView view =
        RenderModelView(tracked, frame.index, live_.camera());
    const auto counting = SurfacesThatCount(frame.index, depth, mask);
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        if (!(depth(v, u) > 0)) continue;
        const auto tally = counting.find(mask(v, u));
        if (tally == counting.end()) continue;
        AddPixel(depth(v, u), view.depth(v, u), view.surface(v, u),
                 tally->second);
      }
    }
  }

  std::vector<DepthAgreement> Result() const {
    std::vector<DepthAgreement> result;
    for (const auto& [id, tally] : tallies_) {
      result.push_back(tally.agreement);
      result.back().distances = tally.distances.Statistics();
    }
    return result;
  }

 private:
  /// Those that were tracked, and those that were not although they are in
  /// plain view: these are not rendered, and so uncovered.
  std::map<int, Tally*> SurfacesThatCount(int frame,
                                          const cv::Mat_<float>& depth,
                                          const cv::Mat_<std::uint16_t>& mask) {
    std::map<int, int> pixels = CountPixels(mask, &depth);
    std::map<int, Tally*> counting;
    for (const AnimatedSurface& surface : surfaces_) {
      const int id = surface.recorded().id;
      const bool tracked = surface.Tracked(frame);
      if (!tracked && pixels[id] <= plain_view_pixels_) continue;
      Tally& tally = tallies_.at(id);
      ++(tracked ? tally.agreement.frames : tally.agreement.frames_missing);
      counting[id] = &tally;
    }
    return counting;
  }

  const LiveImages& live_;
  const std::vector<AnimatedSurface>& surfaces_;
  int plain_view_pixels_;
  Tallies tallies_;
};

}  // namespace

std::vector<DepthAgreement> CompareDepth(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    int every, int plain_view_pixels) {
  const LiveImages live(run);
  Comparer comparer(live, surfaces, plain_view_pixels);
  for (std::size_t i = 0; i < run.frames.size(); i += every) {
    comparer.Add(run.frames[i]);
  }
  return comparer.Result();
}

}  // namespace splitfusion
