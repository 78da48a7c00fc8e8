#ifndef SPLITFUSION_LIB_TSDF_RELEASE_BLOCKS_H_
#define SPLITFUSION_LIB_TSDF_RELEASE_BLOCKS_H_

#include <cstddef>

#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Frees the blocks of a volume that hold nothing of the surface, nor do those
/// around them: what was carved, or forgotten. If fusion needs them again they
/// begin anew. All other blocks keep their voxels and their order, but not
/// their numbers: what is kept by block has to be made anew. Returns the number
/// of blocks freed.
std::size_t ReleaseFreeBlocks(TsdfVolume* volume);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_RELEASE_BLOCKS_H_
