#ifndef SPLITFUSION_LIB_SPLIT_SPLIT_OPTIONS_H_
#define SPLITFUSION_LIB_SPLIT_SPLIT_OPTIONS_H_

#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/split/assignment_options.h"
#include "splitfusion/lib/split/graph_cut.h"
#include "splitfusion/lib/split/merge_groups.h"
#include "splitfusion/lib/split/surface_prior.h"

namespace splitfusion {

/// How detections become surfaces; defaults hold for TUM-like sequences.
struct SplitOptions {
  GraphCutOptions graph_cut;     ///< Edges of the cut.
  PriorOptions prior;            ///< Evidence for it.
  AssignmentOptions assignment;  ///< Of detections to tracks.
  int uncertain_band = 5;        ///< Background that is left alone: pixels
                                 ///< around every surface.
  double min_score = 0.4;        ///< A detection below counts only if it covers
                                 ///< a known surface well.
  double max_area = 0.75;        ///< Fraction of the image; larger likewise.
  int min_pixels = 600;          ///< With depth; smaller instances are ignored.
  int min_island = 60;           ///< Pixels; smaller islands are no part of a
                                 ///< surface.
  int max_missed_frames = 15;    ///< Kept alive without a detection.
  int birth_frames = 2;          ///< Detections that make a surface, less half
                                 ///< of the frames without one; twice as many
                                 ///< if it stands where background has been
                                 ///< mapped for long.
  double confident_score = 0.5;  ///< A detection of the first frame makes a
                                 ///< surface at once from this score on.
  /// A newcomer is a part of the surface that it touches along this share of
  /// its border.
  double min_contact = 0.12;
  /// Detections of rigid classes are "background" until they are seen to have
  /// moved, or get surfaces of their own, "separate".
  std::string rigid_objects = "background";
  bool unknown_movers = true;  ///< What stands where space was seen empty is
                               ///< no background, detected or not.
  std::string merge_touching;  ///< One surface while they touch, see
                               ///< ParseMergeGroups().

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
  /// @throw OptionError if a value is out of its range.
  void Check() const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SPLIT_OPTIONS_H_
