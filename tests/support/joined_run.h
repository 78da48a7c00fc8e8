#ifndef SPLITFUSION_TESTS_SUPPORT_JOINED_RUN_H_
#define SPLITFUSION_TESTS_SUPPORT_JOINED_RUN_H_

#include <string>

#include "support/bent_plate.h"

namespace splitfusion {

/// The run of a BentPlate (12 frames), the plate of which has three parts, each
/// the whole plate: one that was refuted after frame 2, a model from frame 1 to
/// 5, and, re-anchored, one from frame 6 on. In frame 8 it is inactive. Besides
/// surface 2, `ball`, a rigid sheet that moves along x by 1 cm a frame as the
/// camera sees it, in frames 4 to 8.
struct JoinedRun {
  BentPlate plate;  ///< What it is made of.

  /// Writes the run directory.
  void Write(const std::string& folder) const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_JOINED_RUN_H_
