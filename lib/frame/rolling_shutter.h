#ifndef SPLITFUSION_LIB_FRAME_ROLLING_SHUTTER_H_
#define SPLITFUSION_LIB_FRAME_ROLLING_SHUTTER_H_

#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// An image whose rows were exposed one after the other while the camera moved,
/// as it would be if all had been exposed with the middle one (Ringaby and
/// Forssen, Scan Rectification for Structured Light Range Sensors with Rolling
/// Shutters, ICCV 2011). What a row lies below the middle, as a share k of the
/// height, it saw later by k of the time that all rows take: a point X of then
/// was at X + k (M X - X). What moves by itself is taken to stand still.
class RollingShutter {
 public:
  /// `depth`: HxW 32FC1, metres, 0 = none, rows as exposed. `motion`: M, of
  /// points that stand still in the camera frame while all rows are exposed,
  /// metres.
  RollingShutter(const cv::Mat_<float>& depth, const PinholeCamera& camera,
                 const Rigid3d& motion);

  /// Where the image as exposed shows what each pixel shows: HxW, (u, v).
  const cv::Mat_<cv::Vec2f>& places() const { return places_; }

  /// The depth image: HxW, metres, interpolated within a surface, else that of
  /// the nearest pixel.
  cv::Mat_<float> Depth() const;

 private:
  Eigen::Vector3f Moved(const Eigen::Vector3f& point) const {
    return motion_ * point - point;
  }
  float SampleDepth(const cv::Vec2f& place) const;

  cv::Mat_<float> depth_;
  PinholeCamera camera_;
  Rigid3f motion_;
  cv::Mat_<cv::Vec2f> places_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_FRAME_ROLLING_SHUTTER_H_
