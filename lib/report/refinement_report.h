#ifndef SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_
#define SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_

#include <string>
#include <vector>

#include "splitfusion/lib/model/hidden_motions.h"

namespace splitfusion {

/// Lines of `refinement.jsonl`, one a window; keys and units in
/// docs/report_format.md. `surface`: id.
std::string RefinementLines(int surface,
                            const std::vector<RefinedWindow>& windows);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_REFINEMENT_REPORT_H_
