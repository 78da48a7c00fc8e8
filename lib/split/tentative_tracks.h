#ifndef SPLITFUSION_LIB_SPLIT_TENTATIVE_TRACKS_H_
#define SPLITFUSION_LIB_SPLIT_TENTATIVE_TRACKS_H_

#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/split/appearance.h"

namespace splitfusion {

/// A thing that was detected and is not yet believed to be a surface.
struct TentativeTrack {
  cv::Mat_<uchar> mask;   ///< HxW, 255 inside, when last detected.
  Appearance appearance;  ///< Then.
  int frame = 0;          ///< Of that detection.
  double evidence = 0;    ///< In detections: see TentativeTracks.
  bool moves = false;     ///< Of a rigid class, and moves on its own.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(mask, appearance, frame, evidence, moves);
  }
};

/// Things that may become surfaces. The evidence for each counts its
/// detections; a frame without one takes half of one back (a round number, not
/// a measured rate), and what has no evidence left is forgotten.
class TentativeTracks {
 public:
  /// All of them; indices hold until EndFrame().
  const std::vector<TentativeTrack>& all() const { return tracks_; }

  /// Records a detection (HxW, 255 inside) of track `index`, of a new one if
  /// -1, and returns its index. `counts`: whether it speaks for a surface.
  int Record(int index, int frame, const cv::Mat_<uchar>& mask,
             const Appearance& appearance, bool counts);

  /// Adds a thing that was found to move, with the evidence of so many
  /// detections.
  void AddMoving(const cv::Mat_<uchar>& mask, const Appearance& appearance,
                 int frame, double evidence) {
    tracks_.push_back({mask, appearance, frame, evidence, /*moves=*/true});
  }

  /// The track has become a surface: it is forgotten at the end of the frame.
  void Confirm(int index) { tracks_.at(index).evidence = 0; }

  /// Takes evidence from what was not detected in this frame, and forgets what
  /// has none.
  void EndFrame(int frame);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(tracks_);
  }

 private:
  std::vector<TentativeTrack> tracks_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_TENTATIVE_TRACKS_H_
