#ifndef SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_
#define SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/tracking/dense_flow.h"
#include "splitfusion/lib/tracking/feature_network.h"
#include "splitfusion/lib/tracking/image_features.h"
#include "splitfusion/lib/tracking/point_motion.h"

namespace splitfusion {

/// How points of a surface are matched from one frame to the next.
struct MatchOptions {
  int spacing = 4;          ///< Of points that flow is asked for, pixels.
  double max_return = 1.5;  ///< Of the flow there and back, pixels.
  bool features = true;     ///< Where flow is often lost, features are matched.
  /// ONNX file of the network that finds features (FeatureNetwork); empty: they
  /// are SIFT's.
  std::string feature_model;
  double min_score = 0.05;   ///< Of the network's features.
  double min_cosine = 0.82;  ///< Of the angle between two that match.
  /// Share of the points about a pixel that flow lost, above which it is.
  double lost_share = 0.25;
  double reach = 80;  ///< How far features are looked for, pixels.
  /// A feature of SIFT is matched if the angle to the one that is most like it
  /// is below this fraction of that to the second.
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
/// back, as of a hand that moves by more than it is wide, by features (SIFT, or
/// those of a network) that look alike within the surface. Beside these flow
/// counts only where it agrees: of a fast limb it is mostly wrong, also where
/// it does come back. Some matches are wrong.
class FrameMatcher {
 public:
  /// `options`: as checked.
  ///
  /// @throw InputError as FeatureNetwork does.
  explicit FrameMatcher(MatchOptions options);

  /// Looks at the image of the live frame.
  void Begin(const LiveView& live);

  /// Matches of a surface; `from` in the camera frame of the frame before, `to`
  /// in that of the live one, which was begun. `flow`: of the surface, to the
  /// live frame; null if it was not followed. None before a frame was kept.
  /// Thread-safe.
  std::vector<PointMotion> Match(int surface, const LiveView& live,
                                 const DenseFlow* flow) const;

  /// Takes the live frame, whose labels are known now, for the one before.
  void Keep(const LiveView& live);

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(before_, depth_, surfaces_);
  }

 private:
  /// What is seen in a frame.
  struct Image {
    cv::Mat_<std::uint8_t> grey;  // Empty: of no frame yet.
    ImageFeatures features;       // Of the network.

    template <typename Archive>
    void Serialize(Archive* archive) {
      (*archive)(grey, features);
    }
  };

  std::vector<PixelMatch> MatchFeatures(
      const cv::Mat_<std::uint8_t>& region,
      const cv::Mat_<std::uint8_t>& surface) const;
  std::vector<PointMotion> Lifted(const std::vector<PixelMatch>& matches,
                                  int surface, const LiveView& live) const;

  MatchOptions options_;
  std::unique_ptr<FeatureNetwork> network_;  // Null: features are SIFT's.
  Image live_;
  Image before_;
  cv::Mat_<float> depth_;  // Of the frame before.
  // Of its certain pixels with depth: id of the surface; else kNone.
  cv::Mat_<std::uint16_t> surfaces_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_FRAME_MATCHER_H_
