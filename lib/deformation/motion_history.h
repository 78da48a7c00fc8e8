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

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(frame, tracked, motions);
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

/// Writes `motions.bin`, little endian: 8 bytes "SFMOTN01", uint32 frames F,
/// uint32 nodes N, then per frame int32 frame index, int32 tracked (0 or 1),
/// and N x 12 float32 (R row by row, then t).
///
/// @throw InputError if the file cannot be written.
void WriteMotions(const std::string& path, const MotionHistory& history);

/// Reads what WriteMotions wrote.
///
/// @throw InputError on a missing, truncated or foreign file.
MotionHistory ReadMotions(const std::string& path);

/// Writes `graph.json`: {"node_spacing", "neighbors_per_point", "positions":
/// [[x, y, z], ...], "edges": [[j, ...], ...], "first_seen": [frame, ...],
/// "sightings": [[first, last, first, last, ...], ...]}; positions canonical,
/// metres; edges[i] are the neighbours of node i. Motions are in motions.bin.
///
/// @throw InputError if the file cannot be written.
void WriteGraph(const std::string& path, const DeformationGraph& graph,
                int neighbors_per_point);

/// Reads what WriteGraph wrote; motions are identity. `neighbors_per_point`
/// may be null. "first_seen" and "sightings" may be missing or empty.
///
/// @throw InputError on a missing or malformed file; names the field.
DeformationGraph ReadGraph(const std::string& path, int* neighbors_per_point);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_MOTION_HISTORY_H_
