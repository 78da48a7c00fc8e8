#ifndef SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
#define SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_

#include <string>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// Motions of all nodes of one surface in one frame, camera from canonical.
struct FrameMotions {
  int frame = 0;        ///< Frame index.
  bool tracked = true;  ///< False if the motion was carried over (lost frame or
                        ///< surface out of view).
  std::vector<NodeMotion> motions;  ///< Per node of the final graph.
  /// Per node whether live depth showed the surface where the node was; of
  /// nodes that were born later it did not. Nodes without an entry were not
  /// seen.
  std::vector<char> seen = {};

  /// Whether a node was.
  bool Saw(int node) const {
    return node < static_cast<int>(seen.size()) && seen[node] != 0;
  }

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, tracked, motions, seen);
  }
};

/// Motions of one surface through time, by ascending frame. Nodes born later
/// have motions in the earlier frames too (blended from the nodes that existed
/// then), so that every vertex of the final model can be carried to every
/// frame since the surface's birth.
struct MotionHistory {
  std::vector<FrameMotions> frames;  ///< Ascending by frame index.

  /// Motions of a frame; null if the surface has none for it.
  const FrameMotions* Find(int frame) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frames);
  }
};

/// Writes `motions.bin`, little endian: 8 bytes "SFMOTN03" (the last two are
/// the version), uint32 frames F, uint32 nodes N, then per frame int32 frame
/// index, int32 tracked (0 or 1), N x 12 float32 (R row by row, then t), and
/// N uint8 (1: seen); uint64 XXH3 of all bytes before it.
///
/// @throw InputError if the file cannot be written.
void WriteMotions(const std::string& path, const MotionHistory& history);

/// Reads what WriteMotions wrote, files of version 02, which do not say what
/// was seen, and of version 01, which have no checksum either.
///
/// @throw InputError on a missing, truncated, damaged or foreign file; also if
///     frames do not ascend or a motion is not finite or no rotation.
MotionHistory ReadMotions(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
