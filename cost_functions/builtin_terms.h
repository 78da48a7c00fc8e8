#ifndef SPLITFUSION_COST_FUNCTIONS_BUILTIN_TERMS_H_
#define SPLITFUSION_COST_FUNCTIONS_BUILTIN_TERMS_H_

#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/term_registry.h"

namespace splitfusion {

/// Registry with the built-in terms: point_to_plane (Eq. 5), arap (Eq. 6), and
/// not in the paper color, live_to_model, tracks and temporal_arap.
TermRegistry BuiltinTerms();

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_BUILTIN_TERMS_H_
