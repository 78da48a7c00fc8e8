#include "splitfusion/lib/split/split_options.h"

#include "splitfusion/lib/split/merge_groups.h"

namespace splitfusion {

void SplitOptions::List(OptionList* list) {
  list->Number("min_score", &min_score, Range::Share(), "",
               "Detections with a lower score make no surface.")
      .common = true;
  list->Choice("rigid_objects", &rigid_objects, {"background", "separate"},
               "Rigid classes: background (until they move) or separate "
               "(surfaces of their own).")
      .common = true;
  list->Switch(
      "unknown_movers", &unknown_movers,
      "What stands where space was seen empty is no background, detected "
      "or not, for as long as it stands there; only where there are masks.");
  list->Text("merge_touching", &merge_touching,
             "CLASS+CLASS,...: instances of later classes that touch one of "
             "the first belong to it, as in person+teddy bear.")
      .common = true;
  list->Number("max_detection_area", &max_area, {0, 1, true}, "of the image",
               "A larger detection makes no surface.");
  list->Number("min_instance_pixels", &min_pixels, Range::AtLeast(1), "pixels",
               "Instances with fewer pixels with depth are ignored.");
  list->Number("min_island", &min_island, Range::AtLeast(0), "pixels",
               "Smaller islands of a surface are no part of it.");
  list->Number("max_missed_frames", &max_missed_frames, Range::AtLeast(0),
               "frames", "A surface is followed so long without a detection.");
  list->Number(
      "birth_frames", &birth_frames, Range::AtLeast(1), "frames",
      "A detection counts 1, a frame without one takes 1/2 back; the "
      "sum that makes a surface, twice as much where background was "
      "mapped for long, or, unless rigid_objects is separate, of a rigid "
      "class.");
  list->Number("confident_score", &confident_score, Range::Share(), "",
               "From this score on a detection of the first frame makes a "
               "surface at once.");
  list->Number("min_contact", &min_contact, {0, 1, true}, "",
               "A new detection is a part of a surface of its class that it "
               "touches along "
               "this share of its border.");
  list->Number("uncertain_band", &uncertain_band, {0, 100}, "pixels",
               "Background so near to a surface is neither tracked nor fused.");
  list->Part("cut_", &graph_cut);
  list->Part("evidence_", &prior);
  list->Part("assignment_", &assignment);
}

void SplitOptions::Check() const {
  CheckOptions(*this);
  ParseMergeGroups(merge_touching);
}

}  // namespace splitfusion
