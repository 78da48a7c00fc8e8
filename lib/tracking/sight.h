#ifndef SPLITFUSION_LIB_TRACKING_SIGHT_H_
#define SPLITFUSION_LIB_TRACKING_SIGHT_H_

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/typical_points.h"
#include "splitfusion/lib/tracking/image_features.h"

namespace splitfusion {

/// How a surface looked in one frame.
struct Sight {
  int u = 0;                    ///< Of the first column in the image.
  int v = 0;                    ///< Of the first row.
  cv::Mat_<std::uint8_t> grey;  ///< Of its pixels and what is about them.
  cv::Mat_<float> depth;        ///< Of its certain pixels, metres; else 0.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(u, v, grey, depth);
  }
};

/// What is certain of a surface in the live frame (IsCertain()); none if
/// nothing is.
std::optional<Sight> SightOf(int surface, const LiveView& live);

/// What a surface is known by: features, and where each lies.
struct Landmarks {
  ImageFeatures features;               ///< Of SIFT; pixels within the sight.
  std::vector<Eigen::Vector3f> points;  ///< Camera frame, metres.

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(features, points);
  }
};

/// Landmarks of a sight; `most`: only so many, of most contrast; 0: all.
Landmarks LandmarksOf(const Sight& sight, const PinholeCamera& camera,
                      int most = 0);

/// A motion by which landmarks went from one place to another.
struct LandmarkMotion {
  Rigid3d motion;       ///< Of the camera frame, metres.
  int points = 0;       ///< That agree.
  TypicalPoints where;  ///< Where these were before, camera frame, metres.
};

/// The rigid motion, camera frame, on which most matches of features agree that
/// look alike, wherever they are; none if too few do. `ratio` as
/// MatchOptions::ratio.
std::optional<LandmarkMotion> FindLandmarkMotion(const Landmarks& before,
                                                 const Landmarks& now,
                                                 const DepthNoise& noise,
                                                 double ratio);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_SIGHT_H_
