#include "splitfusion/lib/evaluation/point_follower.h"

#include <map>
#include <opencv2/core.hpp>
#include <optional>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/live_images.h"
#include "splitfusion/lib/evaluation/surface_attachment.h"

namespace splitfusion {
namespace {

/// Surface ids of the pixels of one frame; knows nothing if the run has no
/// masks or no camera.
class FrameMask {
 public:
  FrameMask(const RecordedRun& run, const RecordedFrame& frame) {
    if (!run.camera) return;
    camera_ = *run.camera;
    labels_ = ReadIds(run.root + "/masks", frame, camera_);
  }

  bool known() const { return !labels_.empty(); }

  /// Surface id at the pixel of a point (camera frame); 0 if none.
  int IdAt(const Eigen::Vector3d& point) const {
    if (!known()) return 0;
    const auto pixel = camera_.PixelOf(point.cast<float>());
    return pixel ? labels_(pixel->y(), pixel->x()) : 0;
  }

 private:
  PinholeCamera camera_;
  cv::Mat_<std::uint16_t> labels_;
};

/// A query on its way.
struct FollowedPoint {
  Eigen::Vector3d position;  ///< Camera frame of the current frame.
  std::optional<Attachment> attachment;
};

class Follower {
 public:
  Follower(const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
           const std::vector<TrackPoint>& queries)
      : run_(run), surfaces_(surfaces) {
    for (const TrackPoint& query : queries) {
      points_.push_back({query.position, std::nullopt});
    }
  }

  /// Attaches all points to the surfaces that are there in `frame`.
  bool Attach(const RecordedFrame& frame) {
    return Attach(frame, [](const AnimatedSurface&) { return true; });
  }

  /// Attaches what is not attached to the surfaces that begin, or of which a
  /// part has ended since the frame `before`. One that begins also takes over
  /// points of the background that lie on it: they were not yet told apart from
  /// it.
  void Reattach(const RecordedFrame& before, const RecordedFrame& frame) {
    Attach(frame, [&](const AnimatedSurface& surface) {
      return surface.BeginsIn(frame.index) ||
             surface.EndsBetween(before.index, frame.index);
    });
  }

  /// Carries all points from one frame into the next.
  void Advance(const RecordedFrame& from, const RecordedFrame& to) {
    const Rigid3d to_from =
        to.pose.world_from_camera.inverse() * from.pose.world_from_camera;
    std::map<int, WarpField> warps;
    for (const AnimatedSurface& surface : surfaces_) {
      if (surface.HasMotions(to.index)) {
        warps.emplace(surface.recorded().id, surface.WarpAt(to.index));
      }
    }
    for (FollowedPoint& point : points_) {
      // A part that is not in use any more says nothing of the frame.
      if (point.attachment && !IsInUse(*point.attachment, to.index)) {
        point.attachment.reset();
      }
      const auto warp =
          point.attachment
              ? warps.find(point.attachment->surface->recorded().id)
              : warps.end();
      point.position = warp != warps.end()
                           ? point.attachment->PositionAt(warp->second)
                           : to_from * point.position;
    }
  }

  const std::vector<FollowedPoint>& points() const { return points_; }

 private:
  template <typename Condition>
  bool Attach(const RecordedFrame& frame, const Condition& condition) {
    std::vector<const AnimatedSurface*> present;
    for (const AnimatedSurface& surface : surfaces_) {
      if (surface.HasMotions(frame.index) && condition(surface)) {
        present.push_back(&surface);
      }
    }
    if (present.empty()) return false;
    const FrameMask mask(run_, frame);
    const SurfaceAttacher attacher(present, frame.index);
    for (FollowedPoint& point : points_) {
      if (point.attachment && point.attachment->surface->recorded().id != 0) {
        continue;
      }
      const std::optional<Attachment> found =
          attacher.Attach(point.position, mask.IdAt(point.position));
      if (!found ||
          (point.attachment && (found->offset.norm() > kForegroundDistance ||
                                !found->surface->BeginsIn(frame.index)))) {
        continue;
      }
      point.attachment = found;
    }
    return mask.known();
  }

  static bool IsInUse(const Attachment& attachment, int frame) {
    return attachment.surface->recorded().graph.IsInUse(
        attachment.skinning.nodes[0], frame);
  }

  const RecordedRun& run_;
  const std::vector<AnimatedSurface>& surfaces_;
  std::vector<FollowedPoint> points_;
};

void Append(const std::vector<TrackPoint>& queries, int frame,
            const Follower& follower, FollowedPoints* result) {
  for (std::size_t i = 0; i < queries.size(); ++i) {
    result->points.push_back(
        {queries[i].id, frame, follower.points()[i].position});
  }
}

const RecordedFrame& QueryFrame(const RecordedRun& run,
                                const std::vector<TrackPoint>& queries) {
  const int frame = queries.front().frame;
  for (const TrackPoint& query : queries) {
    CheckOption(query.frame == frame, "frame of a query point", query.frame,
                "one frame for all, " + std::to_string(frame));
  }
  const RecordedFrame* found = run.Find(frame);
  CheckOption(
      found != nullptr, "frame of the query points", frame,
      "a frame of the run, 0.." + std::to_string(run.frames.back().index));
  return *found;
}

}  // namespace

FollowedPoints FollowPoints(const RecordedRun& run,
                            const std::vector<AnimatedSurface>& surfaces,
                            const std::vector<TrackPoint>& queries,
                            int frames) {
  FollowedPoints result;
  if (queries.empty()) return result;
  const RecordedFrame* frame = &QueryFrame(run, queries);
  Follower follower(run, surfaces, queries);
  result.by_mask = follower.Attach(*frame);
  Append(queries, frame->index, follower, &result);
  const int last = frame->index + frames;
  for (const RecordedFrame& next : run.frames) {
    if (next.index <= frame->index || next.index > last) continue;
    follower.Advance(*frame, next);
    follower.Reattach(*frame, next);
    Append(queries, next.index, follower, &result);
    frame = &next;
  }
  for (const FollowedPoint& point : follower.points()) {
    ++(point.attachment ? result.attached : result.unattached);
  }
  return result;
}

}  // namespace splitfusion
