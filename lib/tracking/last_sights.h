#ifndef SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_
#define SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_

#include <Eigen/Core>
#include <map>
#include <optional>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/tracking/sight.h"

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
  struct PosedSight {
    Sight sight;
    Eigen::Matrix4d pose;  // Camera from canonical.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(sight, pose);
    }
  };

  std::map<int, PosedSight> sights_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_LAST_SIGHTS_H_
