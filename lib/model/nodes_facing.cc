#include "splitfusion/lib/model/nodes_facing.h"

namespace splitfusion {

std::vector<char> NodesFacing(const TriangleMesh& mesh,
                              const std::vector<SkinningSupport>& supports,
                              const DeformationGraph& graph) {
  std::vector<Eigen::Vector3d> normals(graph.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < supports.size(); ++i) {
    normals[supports[i].nearest] += mesh.normals[i].cast<double>();
  }
  std::vector<char> facing(graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    const NodeMotion& motion = graph.motions[i];
    const Eigen::Vector3d place = graph.positions[i] + motion.translation;
    facing[i] = place.dot(motion.rotation * normals[i]) < 0;
  }
  return facing;
}

}  // namespace splitfusion
