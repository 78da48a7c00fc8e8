#include "splitfusion/lib/split/assignment_options.h"

namespace splitfusion {

void AssignmentOptions::List(OptionList* list) {
  list->Number("equal_iou", &equal_iou, Range::Share(), "",
               "IoU of detection and projection that tells nothing.");
  list->Number("iou_slope", &iou_slope, Range::AtLeast(0), "",
               "Log-likelihood ratio for a unit of IoU more.");
  list->Number("equal_color", &equal_color, Range::Share(), "",
               "Intersection of colour histograms that tells nothing.");
  list->Number("color_slope", &color_slope, Range::AtLeast(0), "",
               "Log-likelihood ratio for a unit of it more.");
  list->Number(
      "place_sigma", &place_sigma, Range::Above(0), "metres",
      "Standard deviation of the place between two frames; also in the "
      "search for a surface that is found again.");
  list->Number(
      "way", &way, Range::AtLeast(0), "metres",
      "Added to it for every frame since the last detection, or, in the "
      "search, since it was tracked; also the longest way of the frame in "
      "which a standing thing begins to move.");
  list->Number(
      "room", &room, Range::Above(0), "metres",
      "Extent of the room, where others are anywhere; the deviation is "
      "no greater.");
  list->Number("limit", &limit, Range::Above(0), "",
               "Largest log-likelihood ratio of one cue.");
  list->Number(
      "untrusted", &untrusted, Range::AtLeast(0), "",
      "Least log-likelihood ratio of the overlap for a detection that may "
      "not become a surface (3: an IoU of 0.5).");
  list->Number("min_contained", &min_contained, Range::Share(), "",
               "Share of a detection inside of a surface that makes it a piece "
               "of it.");
}

}  // namespace splitfusion
