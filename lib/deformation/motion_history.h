#ifndef SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
#define SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_

#include <string>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// Nodes that follow one another.
struct NodeRange {
  int begin = 0;  ///< Index of the first one.
  int end = 0;    ///< Index behind the last one.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(begin, end);
  }
};

/// Motions of the nodes of one surface in one frame, camera from canonical: of
/// all of them, or of those that are in use.
struct FrameMotions {
  int frame = 0;        ///< Frame index.
  bool tracked = true;  ///< False if the motion was carried over (lost frame or
                        ///< surface out of view).
  std::vector<NodeMotion> motions;  ///< Per node of `ranges`.
  /// As `motions`, whether live depth showed the surface where the node was; of
  /// nodes that were born later it did not. Nodes without an entry were not
  /// seen.
  std::vector<char> seen = {};
  /// Which nodes these are of, ascending and apart; empty: of all.
  std::vector<NodeRange> ranges = {};

  /// Where a node is in `motions`; -1: it has none.
  int IndexOf(int node) const;

  /// Its motion. It must have one.
  const NodeMotion& Of(int node) const { return motions[IndexOf(node)]; }

  /// Whether a node was seen.
  bool Saw(int node) const {
    const int index = IndexOf(node);
    return index >= 0 && index < static_cast<int>(seen.size()) &&
           seen[index] != 0;
  }

  /// Sets the motions of those nodes that have one here, of all that there are.
  void SpreadTo(std::vector<NodeMotion>* all) const;

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, tracked, motions, seen, ranges);
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

/// Motions of all nodes of a graph in a frame that the history has; nodes that
/// are not in use then have the nearest one that they had.
std::vector<NodeMotion> MotionsOfAll(const MotionHistory& history,
                                     const DeformationGraph& graph, int frame);

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

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
