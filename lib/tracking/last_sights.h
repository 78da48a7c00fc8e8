#ifndef SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_
#define SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_

#include <cstdint>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/tracking/point_motion.h"

namespace splitfusion {

/// How each surface looked when it was last in plain view, so that it is known
/// again by its texture when it is looked for: also turned, where depth and
/// silhouette alone fit many ways.
class LastSights {
 public:
  /// Takes the live frame for the last sight of a surface, which `pose`
  /// carries in it (camera from canonical, of the whole).
  void Keep(int surface, const LiveView& live, const Rigid3d& pose);

  /// The motion of the camera frame that takes a surface from `predicted`
  /// (camera from canonical) to where its features (SIFT) of the last sight are
  /// seen now: the largest consensus of matches over the whole surface. Empty
  /// without a sight, or if too few agree. `ratio`: as MatchOptions::ratio.
  std::optional<Rigid3d> FindMotion(int surface, const LiveView& live,
                                    const Rigid3d& predicted,
                                    double ratio) const;

  /// Forgets that of a surface.
  void Forget(int surface) { sights_.erase(surface); }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(sights_);
  }

 private:
  /// The part of an image in which the surface was.
  struct Sight {
    int u = 0;                    // Of its first column.
    int v = 0;                    // Of its first row.
    cv::Mat_<std::uint8_t> grey;  // With what is about it.
    cv::Mat_<float> depth;        // Of its certain pixels, metres; else 0.
    Eigen::Matrix4d pose;         // Camera from canonical.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(u, v, grey, depth, pose);
    }
  };

  static std::vector<PointMotion> Match(const Sight& sight, int surface,
                                        const LiveView& live, double ratio);

  std::map<int, Sight> sights_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_
