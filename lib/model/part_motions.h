#ifndef SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_
#define SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// One part of a surface through the frames in which it is in use, in the
/// world, for RefineHiddenMotions().
struct PartMotions {
  /// What is known of a node in a frame.
  struct State {
    Eigen::Vector3d place;     ///< Of its centre, metres.
    Eigen::Matrix3d rotation;  ///< World from canonical.
    bool hidden = false;       ///< Whether its motion is sought.
  };

  /// Number of frames.
  int frames() const { return static_cast<int>(states.size()); }
  /// Number of nodes.
  int nodes() const { return static_cast<int>(rest.size()); }
  /// Whether anything is sought.
  bool HasHidden() const;

  int first_node = 0;                       ///< Index among the graph's.
  std::vector<Eigen::Vector3d> rest;        ///< Places, canonical.
  std::vector<std::vector<int>> neighbors;  ///< By their number in the part.
  std::vector<int> indices;                 ///< Of the frames.
  std::vector<std::vector<State>> states;   ///< By frame, then node.
};

/// Where the centres of nodes are, canonical, metres: that of a rigid surface
/// amid its mesh.
std::vector<Eigen::Vector3d> CentersOf(const SurfaceModel& model);

/// The motions of a part, 0..max(1, parts) - 1, and which of them are sought:
/// those of nodes between two sights, and of all between two sights of the
/// part. They begin with the way and the turn with which a node comes into
/// sight again spread over the frames in which it was hidden.
///
/// `centers`: CentersOf(). `world_from_camera`: by frame index, of all frames
/// of the history.
PartMotions MotionsOfPart(const SurfaceModel& model, std::size_t part,
                          const std::vector<Eigen::Vector3d>& centers,
                          const std::map<int, Rigid3d>& world_from_camera);

/// Puts what was sought into the history; the other nodes keep their bits.
void StoreMotions(const PartMotions& motions,
                  const std::map<int, Rigid3d>& world_from_camera,
                  SurfaceModel* model);

/// Of every part of a graph whether it was refuted: it ended while what follows
/// went on. One after which nothing goes on that was there before was a whole
/// model, which ended as its surface was re-anchored.
std::vector<char> WhichWereRefuted(const DeformationGraph& graph);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_PART_MOTIONS_H_
