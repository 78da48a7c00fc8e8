#ifndef SPLITFUSION_LIB_TRACKING_POINT_TRACKS_H_
#define SPLITFUSION_LIB_TRACKING_POINT_TRACKS_H_

#include <Eigen/Core>
#include <map>
#include <opencv2/core.hpp>
#include <set>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/tracking/dense_flow.h"

namespace splitfusion {

/// How points are followed.
struct PointTrackOptions {
  /// Cells of the image in which at most one track begins, pixels; 0: no
  /// points are followed.
  int spacing = 8;
  /// A track ends if flow there and back ends farther than this from where it
  /// began, pixels.
  double max_return = 0.5;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// A point of a surface that is followed from image to image.
struct PointTrack {
  /// On the model, canonical frame, metres.
  Eigen::Vector3f point = Eigen::Vector3f::Zero();
  /// Where it is seen in the last frame, pixels.
  Eigen::Vector2f pixel = Eigen::Vector2f::Zero();

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(point, pixel);
  }
};

/// Points of the surfaces followed over many frames by optical flow, see
/// DenseFlow. Each is anchored in the canonical frame at the model point that
/// was seen there when its track began, so that it tells where that point is
/// now: long tracks hold a surface along itself, where depth lets it slide (Guo
/// et al. 2015; VolumeDeform does so with features). Not in the paper.
///
/// A track ends where the flow back does not return, and where its pixel does
/// not show its surface for sure. It does not come back; another one may begin
/// there.
class PointTracks {
 public:
  /// `options`: as checked.
  explicit PointTracks(PointTrackOptions options) : options_(options) {}

  /// Follows the points of these surfaces into the next frame, whose labels are
  /// known; the tracks of others end.
  void Follow(const LiveView& live, const std::set<int>& surfaces);

  /// Where the points of a surface are seen that was followed. `samples`: what
  /// is in view of it; points of its model that are not beside one are left
  /// out, and those that are more than `max_change` metres nearer or farther
  /// than live depth: something else passes before them. Thread-safe.
  std::vector<TrackedPoint> Find(int surface,
                                 const std::vector<ModelSample>& samples,
                                 const SkinningIndex& index,
                                 const WarpField& warp, const LiveView& live,
                                 double max_change) const;

  /// Begins tracks where the surface has none, of model points that lie on live
  /// depth. It was followed, and just tracked; `samples` are in view of it. May
  /// be called for different surfaces at the same time.
  void Begin(int surface, const std::vector<ModelSample>& samples,
             const WarpField& warp, const LiveView& live);

  /// Ends all tracks of a surface, whose model is another one from now on.
  void End(int surface) { tracks_.erase(surface); }

  /// Those of one surface; it was followed.
  const std::vector<PointTrack>& Of(int surface) const {
    return tracks_.at(surface);
  }

  /// The flow of a surface from the frame before, as Follow() found it; null if
  /// it was not followed, or had no tracks.
  const DenseFlow* FlowOf(int surface) const {
    const auto found = flows_.find(surface);
    return found == flows_.end() ? nullptr : &found->second;
  }

  /// Saves or restores it between two frames, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(tracks_, grey_, flow_);
  }

 private:
  PointTrackOptions options_;
  std::map<int, std::vector<PointTrack>> tracks_;  // By surface.
  cv::Mat_<std::uint8_t> grey_;  // Of the last frame; empty before the first.
  cv::Mat_<cv::Vec2f> flow_;     // To it; 0 where no surface was followed.
  std::map<int, DenseFlow> flows_;  // To it, by surface.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_POINT_TRACKS_H_
