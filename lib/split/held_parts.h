#ifndef SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_
#define SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_

#include <vector>

#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/merge_groups.h"
#include "splitfusion/lib/split/split_work.h"

namespace splitfusion {

// What a person holds is one surface with the person while the two touch
// (SplitOptions::merge_touching). The splitter follows both all the time, each
// with its own id; only the labels that it gives out are those of the whole.
// What holds a part may be held itself: all of them are one whole, the surface
// at the end of the chain. A surface in several segments is one part.

/// Takes what a surface may hold out of its detections: matches of such
/// candidates as pieces become newcomers, and the prior inside of their masks
/// is no longer that of the surface. A candidate that covers most of the
/// surface is not a part of it but the same under another class, and stays.
void TakeOutParts(const std::vector<MergeGroup>& groups,
                  const std::vector<Candidate>& candidates,
                  const InstanceRegistry& registry, SplitWork* work,
                  std::vector<Match>* matches);

/// Gives held parts their own ids in predicted labels, in which they are one
/// with the whole: where they were in `last`, the labels of the frame before,
/// moved with the whole.
void SplitHeldParts(const InstanceRegistry& registry, const LabelImage& last,
                    LabelImage* predicted);

/// Surface that the segment of this index, or its surface if it has one,
/// touches and that may hold it: the one that holds it already, if that still
/// touches it, else the one that it touches along most of its border; 0 if
/// none.
int FindHolder(int index, const std::vector<MergeGroup>& groups,
               const InstanceRegistry& registry, const SplitWork& work);

/// Joins surfaces to those that hold them, and releases them, or hands them to
/// another, after several frames without contact. Parts without detection stay
/// what they are.
void HoldTouchingParts(const std::vector<MergeGroup>& groups,
                       InstanceRegistry* registry, SplitWork* work);

/// Labels in which held parts have the id of the whole.
LabelImage JoinHeldParts(const InstanceRegistry& registry,
                         const LabelImage& labels);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_HELD_PARTS_H_
