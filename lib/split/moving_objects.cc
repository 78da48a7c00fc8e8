#include "splitfusion/lib/split/moving_objects.h"

namespace splitfusion {
namespace {

/// Share of a detection's pixels that must stand in space that was empty. The
/// pixels of others do not count, and may not be more than half.
constexpr double kMovedShare = 0.4;
constexpr double kMaxClaimed = 0.5;

/// Share from which these pixels are not mapped; fewer are noise.
constexpr double kNoticedShare = 0.2;

/// Part of SplitOptions::max_area up to which a detection may move: half of
/// the room is not one object.
constexpr double kMaxAreaPart = 0.5;

}  // namespace

MovingObjects::MovingObjects(const PinholeCamera& camera,
                             const SplitOptions& options)
    : options_(options), space_(camera) {}

bool MovingObjects::IsWatched(const Candidate& candidate) const {
  return candidate.kind == SurfaceKind::kRigid &&
         candidate.score >= options_.min_score &&
         cv::countNonZero(candidate.mask) <=
             kMaxAreaPart * options_.max_area * candidate.mask.total();
}

cv::Mat_<uchar> MovingObjects::Watch(const MotionView& view,
                                     std::vector<Candidate>* candidates) {
  cv::Mat_<uchar> standing_free(view.depth.size(), uchar(0));
  for (Candidate& candidate : *candidates) {
    if (!IsWatched(candidate)) continue;
    const cv::Mat_<uchar> seen = candidate.mask & (view.depth > 0);
    const cv::Mat_<uchar> own = seen & ~view.claimed;
    const cv::Mat_<uchar> moved =
        space_.WasEmpty(own, view.points, view.world_from_camera);
    const int pixels = cv::countNonZero(own);
    const int moved_pixels = cv::countNonZero(moved);
    if (moved_pixels >= kNoticedShare * pixels) standing_free |= moved;
    candidate.moved = pixels >= options_.min_pixels &&
                      pixels >= (1 - kMaxClaimed) * cv::countNonZero(seen) &&
                      moved_pixels >= kMovedShare * pixels;
  }
  space_.Add(view.frame, view.depth, view.world_from_camera);
  return standing_free;
}

}  // namespace splitfusion
