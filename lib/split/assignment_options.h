#ifndef SPLITFUSION_LIB_SPLIT_ASSIGNMENT_OPTIONS_H_
#define SPLITFUSION_LIB_SPLIT_ASSIGNMENT_OPTIONS_H_

#include <algorithm>

#include "splitfusion/lib/base/option_list.h"

namespace splitfusion {

/// Log-likelihood ratios of the cues by which a detection is assigned to a
/// track: "of the same surface" against "of another one".
///
/// Where overlap and colour tell nothing was read off detections of people in
/// the rendered sequences walk_a, walk_b, walk_c, cloth_a, walking_static and
/// walking_long: of the same person / of another one the IoU is over 0.32 /
/// under 0.03 in 19 of 20 pairs, the similarity of colours over 0.63 / under
/// 0.32 (0.47 / 0.40 of strips that are a tenth of him), the way between two
/// frames under 0.26 m / over 0.53 m. Slopes, limit, growth of the way and
/// extent of the room are round numbers that were not fitted.
struct AssignmentOptions {
  double equal_iou = 0.2;     ///< IoU that tells nothing.
  double iou_slope = 10;      ///< Ratio per unit.
  double equal_color = 0.4;   ///< Similarity that tells nothing.
  double color_slope = 15;    ///< Ratio per unit.
  double place_sigma = 0.15;  ///< Deviation of the place, metres ...
  double way = 0.05;          ///< ... and more a frame: a fast walk.
  double room = 2;            ///< Metres; others are anywhere in it.
  double limit = 5;           ///< Of the ratio of one cue.
  /// Of the overlap of a detection that may not become a surface.
  double untrusted = 3;
  /// Share of a detection inside of a surface that makes it a piece of it.
  double min_contained = 0.6;

  /// Standard deviation, metres, of the place of a surface that was last seen
  /// so many frames ago.
  double PlaceDeviation(int frames) const {
    return std::min(room, place_sigma + way * frames);
  }

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_ASSIGNMENT_OPTIONS_H_
