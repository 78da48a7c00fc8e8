#ifndef SPLITFUSION_LIB_VISIBILITY_SEEN_SPACE_H_
#define SPLITFUSION_LIB_VISIBILITY_SEEN_SPACE_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/geometry/rigid3.h"

namespace splitfusion {

/// Remembers depth images of the past, ever fewer of the farther past, and
/// knows by them where space was seen empty: what stands there now has moved.
/// What was never in view, or behind something, is not known to be empty.
class SeenSpace {
 public:
  /// `camera`: of all frames.
  explicit SeenSpace(const PinholeCamera& camera) : camera_(camera) {}

  /// Takes in a frame; frames must come in order. `depth`: HxW 32FC1, metres,
  /// 0 = none.
  void Add(int frame, const cv::Mat& depth, const Rigid3d& world_from_camera);

  /// Pixels of `mask` (HxW, 255 inside) whose points (camera frame) lie where
  /// a remembered frame looked through: it measured clearly more depth in that
  /// direction and all around it. HxW 8UC1, 255.
  cv::Mat_<uchar> WasEmpty(const cv::Mat_<uchar>& mask, const PointMap& points,
                           const Rigid3d& world_from_camera) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(views_);
  }

 private:
  struct View {
    int frame = 0;
    cv::Mat_<float> depth;  // Least depth around a pixel; 0 = not all measured.
    Rigid3f camera_from_world;

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(frame, depth, camera_from_world);
    }
  };

  void Thin();
  bool LookedThrough(const View& view, const Eigen::Vector3f& point) const;

  PinholeCamera camera_;
  std::vector<View> views_;  // By frame.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_SEEN_SPACE_H_
