#ifndef SPLITFUSION_TESTS_SUPPORT_SAMPLE_GRAPHS_H_
#define SPLITFUSION_TESTS_SUPPORT_SAMPLE_GRAPHS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Rigid motion of a rotation vector (radians) and a translation (metres).
Rigid3d MakeMotion(const Eigen::Vector3d& omega,
                   const Eigen::Vector3d& translation);

/// Nodes of the given spacing (metres) over a mesh, tied along it, at rest;
/// eight edges a node.
DeformationGraph CoverWithNodes(const TriangleMesh& mesh, double spacing);

/// The same over a plate of 20 by 10 cm at 1 m, with a node every 4 cm.
DeformationGraph PlateGraph();

/// Turns and moves every node by up to `size` (radians and metres), at random.
void Shake(double size, std::uint32_t seed, DeformationGraph* graph);

/// Moves every node to where `map` carries it (camera frame, metres) and turns
/// it as the map does around it.
void MoveNodes(
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map,
    DeformationGraph* graph);

/// Bends the space about an axis along y: the plane z = `z` is rolled up with
/// the given curvature (1 / m), starting from x = 0.
Eigen::Vector3d Bend(const Eigen::Vector3d& p, double z, double curvature);

/// `count` twists [omega (rad), tau (m)] of up to `size`, at random.
std::vector<std::vector<double>> RandomTwists(int count, double size,
                                              std::uint32_t seed);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SAMPLE_GRAPHS_H_
