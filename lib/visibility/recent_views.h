#ifndef SPLITFUSION_LIB_VISIBILITY_RECENT_VIEWS_H_
#define SPLITFUSION_LIB_VISIBILITY_RECENT_VIEWS_H_

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <opencv2/core.hpp>
#include <optional>

#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// What a frame shows where a point of a surface ought to be.
enum class Sighting {
  kSeen,       ///< The surface, at the depth of the point.
  kUnknown,    ///< Nothing that speaks for or against it: out of view, hidden,
               ///< no depth, another surface.
  kFreeSpace,  ///< Something farther away: the point cannot be there.
};

/// Depth and labels of the last frames (1.8 MB each at 640x480), to tell since
/// when a part of a surface has been in view that became model only now.
class RecentViews {
 public:
  RecentViews() = default;
  /// Forgets all but the last `frames`.
  explicit RecentViews(int frames) : frames_(frames) {}

  /// Adds the next frame; shares its images.
  void Add(int frame, const LiveView& live);

  /// What a frame shows at, and a few pixels around, a point of `surface`
  /// (camera frame, metres); empty if the frame is forgotten.
  std::optional<Sighting> Look(int frame, int surface,
                               const Eigen::Vector3d& point) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(views_);
  }

 private:
  struct View {
    int frame = 0;
    PinholeCamera camera;
    cv::Mat_<float> depth;
    cv::Mat_<std::uint16_t> labels;

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(frame, camera, depth, labels);
    }
  };

  static Sighting LookAround(const View& view, int surface,
                             const Eigen::Vector2d& pixel, double z);

  int frames_ = 30;
  std::deque<View> views_;  // Ascending by frame.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_VISIBILITY_RECENT_VIEWS_H_
