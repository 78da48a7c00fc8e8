#ifndef SPLITFUSION_LIB_DEFORMATION_MOTION_FILE_H_
#define SPLITFUSION_LIB_DEFORMATION_MOTION_FILE_H_

#include <string>

#include "splitfusion/lib/deformation/motion_history.h"

namespace splitfusion {

/// Writes `motions.bin`, little endian: 8 bytes "SFMOTN04" (the last two are
/// the version), uint32 frames F, uint32 nodes N, then per frame int32 frame
/// index, int32 tracked (0 or 1), uint32 ranges R, R x (uint32 first node,
/// uint32 node behind the last one), for the M nodes of these M x 12 float32 (R
/// row by row, then t), and M uint8 (1: seen); uint64 XXH3 of all bytes before
/// it. `nodes`: of the graph.
///
/// @throw InputError if the file cannot be written.
void WriteMotions(const std::string& path, const MotionHistory& history,
                  int nodes);

/// Reads what WriteMotions wrote; files of version 03, which have motions of
/// all nodes in all frames, of 02, which do not say what was seen, and of 01,
/// which have no checksum either. `nodes`: if not null, is set to the number of
/// nodes of which the file tells.
///
/// @throw InputError on a missing, truncated, damaged or foreign file; also if
///     frames or ranges do not ascend or a motion is not finite or no rotation.
MotionHistory ReadMotions(const std::string& path, int* nodes = nullptr);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_FILE_H_
