#ifndef SPLITFUSION_LIB_SPLIT_MASK_TRIMMING_H_
#define SPLITFUSION_LIB_SPLIT_MASK_TRIMMING_H_

#include "splitfusion/lib/split/split_work.h"

namespace splitfusion {

/// Takes out of the masks of known surfaces what is no part of them: pixels
/// that do not hang together in depth with what was predicted of the surface
/// and lie farther from it than a limb reaches. A detector often gives one
/// person pieces of somebody behind. What is taken out is left to the other
/// surfaces, or unconfirmed.
void TrimMasks(SplitWork* work);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_MASK_TRIMMING_H_
