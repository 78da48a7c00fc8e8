#include "splitfusion/lib/evaluation/presence.h"

#include <algorithm>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Sightings = std::vector<const InstanceSighting*>;

bool InPlainView(const InstanceSighting& sighting,
                 const PresenceOptions& options) {
  return sighting.live_pixels > options.plain_view_pixels &&
         (sighting.earlier_pixels < 0 ||
          sighting.earlier_pixels > options.plain_view_pixels / 2);
}

double ShareOf(const InstanceSighting& sighting, int surface) {
  const auto found = sighting.shares.find(surface);
  return found != sighting.shares.end() ? found->second : 0;
}

/// The surface with the greatest sum of shares; -1 if all are 0.
int OneSurface(const Sightings& sightings) {
  std::map<int, double> sums;
  for (const InstanceSighting* sighting : sightings) {
    for (const auto& [surface, share] : sighting->shares) {
      sums[surface] += share;
    }
  }
  int best = -1;
  double best_sum = 0;
  for (const auto& [surface, sum] : sums) {
    if (sum > best_sum) {
      best = surface;
      best_sum = sum;
    }
  }
  return best;
}

/// The first frame that counts: that in which the surface first shows the
/// instance, or the last one that is waited for.
int FirstToCount(const Sightings& sightings, int surface,
                 const PresenceOptions& options) {
  const int last = sightings.front()->frame + kPatienceFrames;
  for (const InstanceSighting* sighting : sightings) {
    if (ShareOf(*sighting, surface) >= options.shown_share) {
      return std::min(sighting->frame, last);
    }
  }
  return surface < 0 ? sightings.front()->frame : last;
}

bool Contains(const std::vector<int>& ascending, int value) {
  return std::binary_search(ascending.begin(), ascending.end(), value);
}

}  // namespace

void PresenceOptions::Check() const {
  CheckOption(plain_view_pixels >= 0, "plain_view_pixels", plain_view_pixels,
              "a number of pixels");
  CheckOption(shown_share > 0 && shown_share <= 1, "shown_share", shown_share,
              "a share > 0 and <= 1");
}

bool InstancePresence::InView(int frame) const {
  return Contains(in_view, frame);
}

bool InstancePresence::Missing(int frame) const {
  return Contains(missing, frame);
}

double InstancePresence::MissingShare() const {
  if (in_view.empty()) return 0;
  return static_cast<double>(missing.size()) /
         static_cast<double>(in_view.size());
}

InstancePresence JudgePresence(const std::vector<InstanceSighting>& sightings,
                               const PresenceOptions& options) {
  Sightings in_view;
  for (const InstanceSighting& sighting : sightings) {
    if (InPlainView(sighting, options)) in_view.push_back(&sighting);
  }
  InstancePresence presence;
  if (in_view.empty()) return presence;
  presence.surface_id = OneSurface(in_view);
  const int first = FirstToCount(in_view, presence.surface_id, options);
  for (const InstanceSighting* sighting : in_view) {
    if (sighting->frame < first) continue;
    presence.in_view.push_back(sighting->frame);
    if (ShareOf(*sighting, presence.surface_id) < options.shown_share) {
      presence.missing.push_back(sighting->frame);
    }
  }
  return presence;
}

}  // namespace splitfusion
