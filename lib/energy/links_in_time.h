#ifndef SPLITFUSION_LIB_ENERGY_LINKS_IN_TIME_H_
#define SPLITFUSION_LIB_ENERGY_LINKS_IN_TIME_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"

namespace splitfusion {

/// What ties nodes of several frames together, for terms over the motions of
/// what was hidden (cost_functions/hidden_motion.h). The graph of such a
/// problem has a node for every node and frame that is sought: its positions
/// are places of rest, canonical, its motions are world from canonical. Nodes
/// with known motions are numbered on behind them.
struct LinksInTime {
  /// Places of rest of the known nodes, canonical, metres.
  std::vector<Eigen::Vector3d> known_positions;
  /// Their motions, world from canonical.
  std::vector<NodeMotion> known_motions;
  /// Directed edges (i, j) of Eq. 6 within a frame, with an end that is sought.
  std::vector<std::array<int, 2>> edges;
  /// A node in three frames in time, in one of which it is sought.
  std::vector<std::array<int, 3>> triples;
  /// Of every triple: the places in these frames times these sum up to the
  /// second difference in time; 1, -2, 1 of frames that follow one another.
  std::vector<std::array<double, 3>> differences;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_LINKS_IN_TIME_H_
