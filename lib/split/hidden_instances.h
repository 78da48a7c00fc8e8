#ifndef SPLITFUSION_LIB_SPLIT_HIDDEN_INSTANCES_H_
#define SPLITFUSION_LIB_SPLIT_HIDDEN_INSTANCES_H_

#include <vector>

#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/split/instance_matcher.h"
#include "splitfusion/lib/split/instance_registry.h"
#include "splitfusion/lib/split/split_work.h"

namespace splitfusion {

/// Looks for followed surfaces of which the prediction shows hardly anything
/// among the detections that overlap no surface. A person who comes out from
/// behind another one, not quite where predicted, is recognised by place, kind
/// and colour. Adds to `matches`, at most one for each candidate.
void RecognizeHidden(const std::vector<Candidate>& candidates,
                     const LabelTable& table, const InstanceRegistry& registry,
                     const SplitWork& work, std::vector<Match>* matches);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_HIDDEN_INSTANCES_H_
