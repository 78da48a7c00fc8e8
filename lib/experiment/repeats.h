#ifndef SPLITFUSION_LIB_EXPERIMENT_REPEATS_H_
#define SPLITFUSION_LIB_EXPERIMENT_REPEATS_H_

#include <string>

#include "splitfusion/lib/experiment/settings.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// Settings that move the voxels of a repeat: `object_voxel` and
/// `background_voxel` become greater or smaller by one to nine millionths,
/// which the number of the repeat decides alone; none for repeat 0.
///
/// @param parts what sf_run says of the undisturbed run.
/// @throw InputError if the voxel sizes are not in `parts`.
Settings ShiftVoxels(const NamedValues& parts, int repeat);

/// Differences() of two runs' parts, but for what ShiftVoxels() makes: empty if
/// the runs are repeats of one another.
std::string DifferencesBeyondRepeats(const NamedValues& before,
                                     const NamedValues& now);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_REPEATS_H_
