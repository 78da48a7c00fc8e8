#include "splitfusion/lib/tracking/motion_predictor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/median.h"

namespace splitfusion {
namespace {

/// Frames after which an unseen surface has slowed down to 1/e: half a second.
constexpr double kRestFrames = 15;

/// The motion of one frame, if `motion` took several: a part of the turn, and
/// of the way of `center` (where the motion began).
Rigid3d MotionOfOneFrame(const Rigid3d& motion, const Eigen::Vector3d& center,
                         int frames) {
  if (frames == 1) return motion;
  const Eigen::AngleAxisd turn(motion.linear());
  Rigid3d part = Rigid3d::Identity();
  part.linear() =
      Eigen::AngleAxisd(turn.angle() / frames, turn.axis()).toRotationMatrix();
  part.translation() =
      center + (motion * center - center) / frames - part.linear() * center;
  return part;
}

}  // namespace

void MotionPredictor::Record(const Rigid3d& world_from_canonical,
                             const Eigen::Vector3d& center, TrackState state) {
  ++frames_since_;
  velocity_ = MotionOf(world_from_canonical, center, state);
  const bool born = !begun_;
  begun_ = true;
  if (state == TrackState::kOccluded) known_.reset();
  hidden_frames_ = state == TrackState::kOccluded ? hidden_frames_ + 1 : 0;
  if (state != TrackState::kTracked && !born) return;
  known_ = world_from_canonical;
  frames_since_ = 0;
}

Rigid3d MotionPredictor::MotionOf(const Rigid3d& world_from_canonical,
                                  const Eigen::Vector3d& center,
                                  TrackState state) {
  if (state == TrackState::kOccluded) return UsualStep();
  // The jump of a surface that was carried on unseen is no velocity.
  if (state != TrackState::kTracked || !known_) {
    return Rigid3d::Identity();
  }
  const Eigen::Vector3d before = *known_ * center;
  if (frames_since_ == 1) {
    steps_.push_back(world_from_canonical * center - before);
    if (steps_.size() > kUsualFrames) steps_.pop_front();
  }
  return MotionOfOneFrame(world_from_canonical * known_->inverse(), before,
                          frames_since_);
}

Rigid3d MotionPredictor::UsualStep() const {
  Rigid3d step = Rigid3d::Identity();
  if (steps_.empty()) return step;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& s : steps_) values.push_back(s[axis]);
    step.translation()[axis] = Median(std::move(values));
  }
  step.translation() *= std::exp(-hidden_frames_ / kRestFrames);
  return step;
}

}  // namespace splitfusion
