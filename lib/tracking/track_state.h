#ifndef SPLITFUSION_LIB_TRACKING_TRACK_STATE_H_
#define SPLITFUSION_LIB_TRACKING_TRACK_STATE_H_

#include <string>

namespace splitfusion {

/// What is usual of a surface, its step and its size, is that of about as
/// many of its last tracked frames.
constexpr int kUsualFrames = 10;

/// What is known of where a surface is, see docs/surfaces_in_time.md.
enum class TrackState {
  kTentative,  ///< Detected, not yet believed to be a surface.
  kTracked,    ///< Its model lies on its live pixels.
  kOccluded,   ///< Too little of it is in view; carried on as predicted.
  kLost,       ///< In plain view, and its model does not fit what is seen.
  kInactive,   ///< Neither detected nor seen for long: kept, not drawn.
};

/// What one frame says of a surface.
enum class TrackEvent {
  kConfirmed,     ///< Enough detections for a surface.
  kDetected,      ///< A detection is of it.
  kGone,          ///< No detection for SplitOptions::max_missed_frames, or
                  ///< nothing hides it and it is not there.
  kLittleInView,  ///< Hardly any of it can be seen, or is.
  kFits,          ///< Tracking succeeded.
  kMisfits,       ///< Tracking failed in plain view.
};

/// State after an event. All transitions there are: an event that does not
/// concern a state leaves it as it is.
TrackState Next(TrackState state, TrackEvent event);

/// "tentative", "tracked", "occluded", "lost" or "inactive".
std::string ToString(TrackState state);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_TRACK_STATE_H_
