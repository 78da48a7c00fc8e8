#include "splitfusion/lib/split/split_options.h"

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

RigidObjects ParseRigidObjects(const std::string& word) {
  const bool separate = word == "separate";
  CheckOption(separate || word == "background", "rigid_objects", word,
              "background or separate");
  return separate ? RigidObjects::kSeparate : RigidObjects::kBackground;
}

void SplitOptions::Check() const {
  graph_cut.Check();
  prior.Check();
  uncertain.Check();
  CheckOption(min_score >= 0 && min_score <= 1, "min_score", min_score, "0..1");
  CheckOption(max_area > 0 && max_area <= 1, "max_area", max_area,
              "a fraction of the image in 0..1");
  CheckOption(min_pixels >= 1, "min_pixels", min_pixels, "at least 1 pixel");
  CheckOption(min_match_iou > 0 && min_match_iou <= 1, "min_match_iou",
              min_match_iou, "0..1, not 0");
  CheckOption(max_missed_frames >= 0, "max_missed_frames", max_missed_frames,
              "a number of frames >= 0");
  CheckOption(birth_frames >= 1, "birth_frames", birth_frames,
              "at least 1 frame");
  CheckOption(confident_score >= 0 && confident_score <= 1, "confident_score",
              confident_score, "0..1");
  CheckOption(min_contact > 0 && min_contact <= 1, "min_contact", min_contact,
              "a share in 0..1, not 0");
}

}  // namespace splitfusion
