#ifndef SPLITFUSION_LIB_SPLIT_SURFACE_MERGING_H_
#define SPLITFUSION_LIB_SPLIT_SURFACE_MERGING_H_

#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/split_work.h"

namespace splitfusion {

/// Surface that the newcomer of this index is a part of: one of its class that
/// it touches along a share of `min_contact` of its border; 0 if none.
int FindBody(int index, const InstanceRegistry& registry, double min_contact,
             const SplitWork& work);

/// Merges for good what turned out to be one: a surface without detection that
/// one of its class touches, while that one's detection covers both, frame
/// after frame.
void MergeCoveredSurfaces(double min_contact, InstanceRegistry* registry,
                          SplitWork* work);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_SURFACE_MERGING_H_
