#ifndef SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_
#define SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/split/split_result.h"
#include "splitfusion/pipelines/own_motion.h"

namespace splitfusion {

/// Detections of rigid classes that are part of the background, until they are
/// found to move on their own.
class StandingObjects {
 public:
  /// One that moves, and how.
  struct Moving {
    StandingObject object;  ///< Where it is seen in this frame.
    OwnMotion motion;       ///< From where it was mapped.
  };

  /// Takes in those detected in a frame, with the labels of its surfaces. One
  /// of frames before that shares half of its pixels with none of them stays
  /// where it was mapped without a detection, for at most `max_missed` frames
  /// in which it is in view: detectors miss things just as they begin to move.
  /// `stride`: model maps hold every so many pixels.
  void Detect(std::vector<StandingObject> detected, int max_missed, int stride,
              const LiveView& live, const Rigid3d& camera_from_canonical);

  /// Whether there are none.
  bool empty() const { return mapped_.empty(); }

  /// Pixels of all of them, of this size, 255.
  cv::Mat_<uchar> Mask(cv::Size size) const;

  /// Takes those out that FindOwnMotion() finds a gain of at least `min_gain`
  /// for, which has the meaning of the other arguments.
  std::vector<Moving> TakeMoving(const std::vector<ModelSample>& samples,
                                 const LiveView& live,
                                 const DeformationGraph& background,
                                 const SurfaceTracker& tracker,
                                 double grazing_angle, double min_gain);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mapped_);
  }

 private:
  struct Mapped {
    StandingObject object;
    int missed = 0;  // Frames in view since its last detection.
    // What was mapped within its mask then: canonical frame of the background,
    // metres.
    std::vector<Eigen::Vector3f> points;
    bool is_new = false;  // Of this frame: the points in view are not there.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(object, missed, points);
    }
  };

  std::vector<Mapped> mapped_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_STANDING_OBJECTS_H_
