#ifndef SPLITFUSION_LIB_ENERGY_TRIAL_SURFACE_H_
#define SPLITFUSION_LIB_ENERGY_TRIAL_SURFACE_H_

#include <cstdint>

namespace splitfusion {

/// SurfaceProblem::surface, and label, of what is solved to see whether it
/// fits, as a motion that a part of a surface might have: no recorder keeps it.
constexpr std::uint16_t kTrialSurface = 65535;  // Layout.

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TRIAL_SURFACE_H_
