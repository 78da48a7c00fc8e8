#ifndef SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_
#define SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/split/split_options.h"
#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/pipelines/own_motion.h"
#include "splitfusion/pipelines/surface_tracker.h"

namespace splitfusion {

struct PipelineOptions;

/// Detections of rigid classes that are part of the background, until they are
/// found to move on their own.
class StandingObjects {
 public:
  /// Watches by the energy of the toolkit, whatever that of `options` is: terms
  /// of others need not bear tries.
  explicit StandingObjects(const PipelineOptions& options);

  /// One that moves.
  struct Moving {
    StandingObject object;  ///< Where it is seen in this frame.
    /// What was mapped of it: canonical frame of the background, metres.
    std::vector<Eigen::Vector3f> points;
  };

  /// Takes in those detected in a frame, with the labels of its surfaces, that
  /// are where they were mapped, and takes those out that FindOwnMotion() finds
  /// a gain of at least `own_motion_gain` for, on average of this frame and the
  /// one before (what noise makes of a thing that stands it makes once), as the
  /// camera sees it that is tracked without any of them; it has just begun, so
  /// that its way is at most the assignment's of one frame. One of frames
  /// before of which none of the detected has more than half of the pixels
  /// stays where it was mapped without a detection, while it is in the map and
  /// for at most `max_missed_frames` in which it is in view: detectors miss
  /// things just as they begin to move.
  ///
  /// `samples`: the background's model points in view; `background`: as tracked
  /// in this frame; `context`: of it, as of SurfaceTracker::Track().
  std::vector<Moving> Watch(std::vector<StandingObject> detected,
                            const std::vector<ModelSample>& samples,
                            const LiveView& live,
                            const DeformationGraph& background,
                            const TermContext& context);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mapped_);
  }

 private:
  struct Mapped {
    StandingObject object;
    int missed = 0;   // Frames in view since its last detection.
    double gain = 0;  // OwnMotion::gain in the frame before.
    // What was mapped within its mask then: canonical frame of the background,
    // metres.
    std::vector<Eigen::Vector3f> points;

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(object, missed, gain, points);
    }
  };

  void Detect(std::vector<StandingObject> detected,
              const std::vector<ModelSample>& samples, const LiveView& live,
              const Rigid3f& camera_from_canonical);
  /// The model points of a detection, canonical frame, metres; none if most are
  /// not where they were mapped: it shows something else.
  std::vector<Eigen::Vector3f> MappedPoints(
      const cv::Mat_<uchar>& mask, const std::vector<ModelSample>& samples,
      const LiveView& live, const Rigid3f& camera_from_canonical) const;
  /// A point of the camera frame compared with a depth, metres.
  DepthState StateOf(const Eigen::Vector3f& point, float depth,
                     const LiveView& live) const;
  /// Tracks the background without what may move, and take the camera along.
  bool TrackApart(const std::vector<ModelSample>& samples, const LiveView& live,
                  const TermContext& context, DeformationGraph* apart) const;
  /// Of its points, those that the motion takes onto the thing where it is
  /// seen, or to where it is not in view: a mask has some of what is beside it.
  std::vector<Eigen::Vector3f> PointsOfThing(
      const Mapped& mapped, const LiveView& live,
      const Rigid3d& camera_from_canonical) const;

  SplitOptions options_;
  int stride_;       // Of the samples, pixels.
  double min_gain_;  // OwnMotion::gain.
  double grazing_;   // Radians.
  SurfaceTracker tracker_;
  std::vector<Mapped> mapped_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_
