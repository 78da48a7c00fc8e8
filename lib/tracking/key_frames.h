#ifndef SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_
#define SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/tracking/sight.h"

namespace splitfusion {

/// When frames are kept, and how the camera is looked for among them.
struct KeyFrameOptions {
  /// A frame is kept if every key frame shows less than this share of what it
  /// shows.
  double overlap = 0.7;
  int landmarks = 1000;  ///< Of a key frame, at most.
  int agreeing = 30;     ///< So many landmarks have to agree on a place.
  int candidates = 5;    ///< Key frames that are compared with.
  double ratio = 0.85;   ///< As MatchOptions::ratio.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// Frames of the static scene that differ in what they show, by which a camera
/// that jumped or was lost is found: those that look most alike as a whole
/// (small images, as in Klein and Murray 2008) are compared by features.
class KeyFrames {
 public:
  /// `options`: as checked.
  explicit KeyFrames(KeyFrameOptions options) : options_(options) {}

  /// The live frame shows the background from where it was tracked. Kept if it
  /// shows what no key frame does; in any case it is the latest one.
  void Keep(const LiveView& live, const Rigid3d& camera_from_world);

  /// Where the camera may be (camera from world, metres), the place on which
  /// most landmarks agree first.
  std::vector<Rigid3d> Find(const LiveView& live) const;

  /// Key frames so far, without the latest frame.
  int size() const { return static_cast<int>(key_frames_.size()); }

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(key_frames_, latest_, latest_pose_);
  }

 private:
  struct KeyFrame {
    Landmarks landmarks;
    cv::Mat_<float> thumbnail;  // One row, mean 0, length 1.
    cv::Mat_<float> depth;      // Coarse, metres.
    Eigen::Matrix4d pose;       // Camera from world.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(landmarks, thumbnail, depth, pose);
    }
  };

  /// Key frames by how alike they look as a whole, at most `candidates`.
  std::vector<const KeyFrame*> MostAlike(const LiveView& live) const;

  KeyFrameOptions options_;
  std::vector<KeyFrame> key_frames_;
  Sight latest_;                                           // May be empty.
  Eigen::Matrix4d latest_pose_ = Eigen::Matrix4d::Zero();  // Likewise.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_
