#ifndef SPLITFUSION_LIB_SPLIT_LOOSE_PARTS_H_
#define SPLITFUSION_LIB_SPLIT_LOOSE_PARTS_H_

#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/split_work.h"

namespace splitfusion {

/// Gives pieces of a body that detector and cut have missed to the body: the
/// head of a person who enters while the neck is still out of the image, a hand
/// whose arm is hidden by another person in front.
///
/// A piece is a patch in front of the mapped background that nothing claims. It
/// belongs to the nearest non-rigid surface, if that is near in space and what
/// connects the two can be out of sight: the body is a mere strip along the
/// border of the image, at which the piece ends too, or both end at something
/// nearer. What stands alone in plain view belongs to no
/// surface. Changes `segment_labels`.
void ClaimLooseParts(const InstanceRegistry& registry, SplitWork* work);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_LOOSE_PARTS_H_
