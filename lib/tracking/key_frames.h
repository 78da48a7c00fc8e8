#ifndef SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_
#define SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/base/spooled_list.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/geometry/typical_points.h"
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

/// What a frame of the static scene showed, and from where.
struct KeyFrame {
  Landmarks landmarks;        ///< Of the background.
  cv::Mat_<float> thumbnail;  ///< One row, mean 0, length 1.
  cv::Mat_<float> depth;      ///< Coarse, metres.
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();  ///< Camera from world.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(landmarks, thumbnail, depth, pose);
  }
};

/// A frame on the way of the camera: a node of the pose graph.
struct PathFrame {
  int frame = -1;        ///< Index in the sequence.
  bool goes_on = false;  ///< Tracked all the way from the one before.
  /// How far off what it shows is, all about the camera, metres.
  TypicalPoints points = TypicalPoints::Zero();
  KeyFrame view;  ///< With its landmarks.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, goes_on, points, view);
  }
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

  /// The same frame as one on the camera's path, before Keep(). On it are
  /// those that show much that the one before on it does not, and those before
  /// and after the camera was lost. `goes_on`: it was not since the latest one.
  ///
  /// @throw InputError if a temporary file cannot be written.
  void KeepOnPath(const LiveView& live, const Rigid3d& camera_from_world,
                  int frame, bool goes_on);

  /// The camera's path so far, up to the latest frame.
  ///
  /// @throw InputError if a temporary file cannot be read.
  std::vector<PathFrame> Path(const PinholeCamera& camera) const;

  /// Where the camera may be (camera from world, metres), the place on which
  /// most landmarks agree first.
  std::vector<Rigid3d> Find(const LiveView& live) const;

  /// Key frames so far, without the latest frame.
  int size() const { return static_cast<int>(key_frames_.size()); }

  /// Saves or restores them, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(key_frames_, latest_, latest_pose_, path_, last_on_path_,
               latest_on_path_);
  }

 private:
  /// Key frames by how alike they look as a whole, at most `candidates`.
  std::vector<const KeyFrame*> MostAlike(const LiveView& live) const;

  /// Takes one more frame on the path.
  void AddToPath(PathFrame frame);

  /// The latest frame with its landmarks.
  PathFrame LatestOnPath(const PinholeCamera& camera) const;

  KeyFrameOptions options_;
  std::vector<KeyFrame> key_frames_;
  Sight latest_;                                           // May be empty.
  Eigen::Matrix4d latest_pose_ = Eigen::Matrix4d::Zero();  // Likewise.
  // Nothing asks for it before the end, but for what its last frame shows.
  SpooledList<PathFrame> path_;
  PathFrame last_on_path_;    // Without landmarks, as the next one.
  PathFrame latest_on_path_;  // Frame -1: none.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_KEY_FRAMES_H_
