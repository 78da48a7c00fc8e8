#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {

TrackState Next(TrackState state, TrackEvent event) {
  if (state == TrackState::kTentative) {
    return event == TrackEvent::kConfirmed ? TrackState::kTracked : state;
  }
  if (state == TrackState::kInactive) {
    return event == TrackEvent::kDetected ? TrackState::kOccluded : state;
  }
  switch (event) {
    case TrackEvent::kGone:
      return TrackState::kInactive;
    case TrackEvent::kLittleInView:
      return TrackState::kOccluded;
    case TrackEvent::kFits:
      return TrackState::kTracked;
    case TrackEvent::kMisfits:
      return TrackState::kLost;
    default:
      return state;
  }
}

std::string ToString(TrackState state) {
  switch (state) {
    case TrackState::kTentative:
      return "tentative";
    case TrackState::kTracked:
      return "tracked";
    case TrackState::kOccluded:
      return "occluded";
    case TrackState::kLost:
      return "lost";
    default:
      return "inactive";
  }
}

}  // namespace splitfusion
