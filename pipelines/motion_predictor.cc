#include "splitfusion/pipelines/motion_predictor.h"

#include <algorithm>
#include <vector>

namespace splitfusion {
namespace {

/// Tracked frames whose steps are remembered.
constexpr std::size_t kSteps = 10;

}  // namespace

void MotionPredictor::Record(const Rigid3d& world_from_canonical,
                             const Eigen::Vector3d& center,
                             Placement placement) {
  velocity_ = MotionOf(world_from_canonical, center, placement);
  last_ = world_from_canonical;
  last_placement_ = placement;
}

Rigid3d MotionPredictor::MotionOf(const Rigid3d& world_from_canonical,
                                  const Eigen::Vector3d& center,
                                  Placement placement) {
  if (placement == Placement::kHidden) return UsualStep();
  // The jump of a surface that is back is no velocity.
  if (placement == Placement::kNotTracked || !last_ ||
      last_placement_ == Placement::kHidden) {
    return Rigid3d::Identity();
  }
  steps_.push_back(world_from_canonical * center - *last_ * center);
  if (steps_.size() > kSteps) steps_.pop_front();
  return world_from_canonical * last_->inverse();
}

Rigid3d MotionPredictor::UsualStep() const {
  Rigid3d step = Rigid3d::Identity();
  if (steps_.empty()) return step;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& s : steps_) values.push_back(s[axis]);
    const auto middle = values.begin() + values.size() / 2;
    std::nth_element(values.begin(), middle, values.end());
    step.translation()[axis] = *middle;
  }
  return step;
}

}  // namespace splitfusion
