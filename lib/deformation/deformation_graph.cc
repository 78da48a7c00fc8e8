#include "splitfusion/lib/deformation/deformation_graph.h"

#include <algorithm>

namespace splitfusion {

DeformationGraph MakeRigidGraph(const Rigid3d& camera_from_canonical) {
  DeformationGraph graph;
  graph.positions.push_back(Eigen::Vector3d::Zero());
  graph.motions.push_back(
      {camera_from_canonical.linear(), camera_from_canonical.translation()});
  graph.neighbors.resize(1);
  return graph;
}

void ApplyRigidMotion(const Rigid3d& motion, DeformationGraph* graph) {
  for (int i = 0; i < graph->size(); ++i) {
    const Eigen::Vector3d& g = graph->positions[i];
    NodeMotion& node = graph->motions[i];
    node.rotation = Orthonormalized(motion.linear() * node.rotation);
    node.translation = motion * (g + node.translation) - g;
  }
}

Rigid3d MeanRigidMotion(const DeformationGraph& graph) {
  // Every node contributes itself and three points along its axes, so that the
  // fit is well posed for a single node too and rotations count.
  const double arm = graph.node_spacing > 0 ? graph.node_spacing : 1.0;
  Eigen::Matrix3Xd from(3, 4 * graph.size());
  Eigen::Matrix3Xd to(3, 4 * graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector3d p = graph.positions[i];
      if (k < 3) p[k] += arm;
      from.col(4 * i + k) = p;
      to.col(4 * i + k) = ApplyNode(graph.positions[i], graph.motions[i], p);
    }
  }
  Rigid3d motion;
  motion.matrix() = Eigen::umeyama(from, to, /*with_scaling=*/false);
  return motion;
}

Eigen::Vector3d Center(const DeformationGraph& graph) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& position : graph.positions) sum += position;
  return graph.positions.empty() ? sum : sum / graph.size();
}

bool DeformationGraph::IsInUse(int node, int frame) const {
  const auto next = std::upper_bound(
      parts.begin(), parts.end(), node,
      [](int index, const ModelPart& part) { return index < part.node; });
  return next == parts.begin() ||
         (next[-1].first_frame <= frame && frame < next[-1].end_frame);
}

}  // namespace splitfusion
