#ifndef SPLITFUSION_LIB_TRACKING_MOTION_PREDICTOR_H_
#define SPLITFUSION_LIB_TRACKING_MOTION_PREDICTOR_H_

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {

/// Predicts the rigid motion of one surface over the next frame.
///
/// A tracked surface keeps the velocity of its last frame; after frames without
/// tracking, its mean velocity since it was tracked last. An occluded one is
/// carried on with the median translation of its centre over the last frames
/// in which it was tracked: its last motions before it vanished were estimated
/// from a strip of it, and their error would be repeated in every frame.
class MotionPredictor {
 public:
  /// The surface lies at `world_from_canonical` in the next frame; `center` is
  /// any point amid it, canonical frame, metres.
  void Record(const Rigid3d& world_from_canonical,
              const Eigen::Vector3d& center, TrackState state);

  /// Predicted motion over the next frame, world from world.
  const Rigid3d& velocity() const { return velocity_; }

  /// Frames since it was tracked last; 0: in the latest one.
  int frames_since() const { return frames_since_; }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(known_, frames_since_, hidden_frames_, begun_, velocity_,
               steps_);
  }

 private:
  Rigid3d MotionOf(const Rigid3d& world_from_canonical,
                   const Eigen::Vector3d& center, TrackState state);
  Rigid3d UsualStep() const;

  // Where live pixels last placed it, world from canonical; none once it was
  // carried on without.
  std::optional<Rigid3d> known_;
  int frames_since_ = 0;   // Since it was placed there.
  int hidden_frames_ = 0;  // On end.
  bool begun_ = false;     // Whether any frame was recorded.
  Rigid3d velocity_ = Rigid3d::Identity();
  std::deque<Eigen::Vector3d> steps_;  // Of the centre, world, metres.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_MOTION_PREDICTOR_H_
