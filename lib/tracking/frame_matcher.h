#ifndef SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_
#define SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/tracking/dense_flow.h"
#include "splitfusion/lib/tracking/point_motion.h"

namespace splitfusion {

/// How points of a surface are matched from one frame to the next.
struct MatchOptions {
  int spacing = 4;          ///< Of points that flow is asked for, pixels.
  double max_return = 1.5;  ///< Of the flow there and back, pixels.
  bool features = true;     ///< Where flow is often lost, features are matched.
  /// Share of the points about a pixel that flow lost, above which it is.
  double lost_share = 0.25;
  double reach = 80;  ///< How far features are looked for, pixels.
  /// A feature is matched if the angle to the one that is most like it is
  /// below this fraction of that to the second.
  double ratio = 0.85;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// A pixel of one image and what looks alike in the next one.
struct PixelMatch {
  cv::Point2f from;  ///< Column and row.
  cv::Point2f to;    ///< Column and row.
};

/// Matches points of a surface between the frame before and the live one, and
/// lifts them by their depth: by dense flow, and where that often does not come
/// back, as of a hand that moves by more than it is wide, by features (SIFT;
/// Lowe 2004) that look alike within the surface. Beside these flow counts only
/// where it agrees: of a fast limb it is mostly wrong, also where it does come
/// back. Some matches are wrong.
class FrameMatcher {
 public:
  /// `options`: as checked.
  explicit FrameMatcher(MatchOptions options) : options_(options) {}

  /// Matches of a surface; `from` in the camera frame of the frame before, `to`
  /// in that of the live one. `flow`: of the surface, to the live frame; null
  /// if it was not followed. None before a frame was kept. Thread-safe.
  std::vector<PointMotion> Match(int surface, const LiveView& live,
                                 const DenseFlow* flow) const;

  /// Takes a frame, whose labels are known, for the one before.
  void Keep(const LiveView& live);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(grey_, depth_, surfaces_);
  }

 private:
  std::vector<PixelMatch> MatchFeatures(const LiveView& live,
                                        const cv::Mat_<std::uint8_t>& region,
                                        int surface) const;
  std::vector<PointMotion> Lifted(const std::vector<PixelMatch>& matches,
                                  int surface, const LiveView& live) const;

  MatchOptions options_;
  cv::Mat_<std::uint8_t> grey_;  // Of the frame before; empty: none was kept.
  cv::Mat_<float> depth_;
  // Of its certain pixels with depth: id of the surface; else kNone.
  cv::Mat_<std::uint16_t> surfaces_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_
