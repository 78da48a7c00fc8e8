#include "splitfusion/lib/split/moving_objects.h"

#include "splitfusion/lib/split/assignment.h"

namespace splitfusion {
MovingObjects::MovingObjects(const PinholeCamera& camera,
                             const SplitOptions& options)
    : options_(options), space_(camera) {}

bool MovingObjects::IsWatched(const Candidate& candidate) const {
  return options_.rigid_objects != "separate" &&
         candidate.kind == SurfaceKind::kRigid &&
         candidate.score >= options_.min_score &&
         cv::countNonZero(candidate.mask) <=
             options_.max_area * candidate.mask.total();
}

cv::Mat_<uchar> MovingObjects::Watch(const MotionView& view,
                                     std::vector<Candidate>* candidates) {
  cv::Mat_<uchar> standing_free(view.depth.size(), uchar(0));
  if (options_.unknown_movers) {
    standing_free = space_.WasEmpty(view.in_front & ~view.claimed, view.points,
                                    view.world_from_camera);
  }
  for (Candidate& candidate : *candidates) {
    if (!IsWatched(candidate)) continue;
    const cv::Mat_<uchar> seen = candidate.mask & (view.depth > 0);
    const cv::Mat_<uchar> moved = space_.WasEmpty(
        seen & ~view.claimed, view.points, view.world_from_camera);
    standing_free |= moved;
    const int pixels = cv::countNonZero(seen);
    candidate.moved =
        pixels >= options_.min_pixels && 2 * cv::countNonZero(moved) >= pixels;
  }
  space_.Add(view.frame, view.depth, view.world_from_camera);
  return standing_free;
}

}  // namespace splitfusion
