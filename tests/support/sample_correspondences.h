#ifndef SPLITFUSION_TESTS_SUPPORT_SAMPLE_CORRESPONDENCES_H_
#define SPLITFUSION_TESTS_SUPPORT_SAMPLE_CORRESPONDENCES_H_

#include <functional>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Every vertex of the mesh with the live point `live` carries it to (camera
/// frame, metres): a perfect association under the graph's current motions.
std::vector<Correspondence> PerfectAssociation(
    const TriangleMesh& mesh, const DeformationGraph& graph,
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& live);

/// Pairs of a plate of 0.1 m with itself, moved (metres).
std::vector<Correspondence> PlateMovedBy(const Eigen::Vector3d& way);

/// Three plates of 0.2 m that meet in a corner: every motion shows.
TriangleMesh CornerMesh(double step);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_SAMPLE_CORRESPONDENCES_H_
