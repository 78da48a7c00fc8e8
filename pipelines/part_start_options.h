#ifndef SPLITFUSION_PIPELINES_PART_START_OPTIONS_H_
#define SPLITFUSION_PIPELINES_PART_START_OPTIONS_H_

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/tracking/rigid_parts.h"

namespace splitfusion {

/// Where the parts of a deforming surface start, see PartStarter.
struct PartStartOptions {
  RigidPartOptions parts;  ///< How they are found.
  /// A part starts where its points were matched if the misfit of what it
  /// carries is there below this fraction of that without.
  double gain = 0.85;
  /// Weight of what no match is near to, which stays; matched points have 1.
  double hold = 0.1;

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_PART_START_OPTIONS_H_
