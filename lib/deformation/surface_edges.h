#ifndef SPLITFUSION_LIB_DEFORMATION_SURFACE_EDGES_H_
#define SPLITFUSION_LIB_DEFORMATION_SURFACE_EDGES_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// The vertex of a mesh next to a node.
struct NodeSeed {
  int vertex = -1;     ///< -1 = none.
  float distance = 0;  ///< Of the node from it, metres.
};

/// Neighbours of every node along the surface of a mesh, ascending.
///
/// Every vertex is given to the node nearest to it along the mesh (one
/// Dijkstra search from all nodes at once); nodes whose regions touch are
/// neighbours, at the length of the shortest path through the border. From
/// these and their neighbours the `count` nearest are kept, both directions of
/// an edge. Pieces of the mesh that hang apart are tied by the shortest edges
/// in space, piece to piece, so that every node is connected with every other.
///
/// `nodes`: canonical positions, metres; `seeds`: where the search from each of
/// them begins; a node without is a piece by itself.
std::vector<std::vector<int>> ConnectAlongSurface(
    const std::vector<Eigen::Vector3d>& nodes,
    const std::vector<NodeSeed>& seeds, const TriangleMesh& mesh, int count);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_DEFORMATION_SURFACE_EDGES_H_
