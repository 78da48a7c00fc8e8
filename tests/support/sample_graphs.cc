#include "support/sample_graphs.h"

#include <Eigen/SVD>
#include <cmath>
#include <random>

#include "splitfusion/lib/deformation/graph_growth.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

double Uniform(double size, std::mt19937* random) {
  // Not std::uniform_real_distribution: its numbers differ by library.
  return size * ((*random)() / 2147483648.0 - 1);
}

Eigen::Vector3d RandomVector(double size, std::mt19937* random) {
  const double x = Uniform(size, random);
  const double y = Uniform(size, random);
  return {x, y, Uniform(size, random)};
}

}  // namespace

Rigid3d MakeMotion(const Eigen::Vector3d& omega,
                   const Eigen::Vector3d& translation) {
  Rigid3d motion = Rigid3d::Identity();
  motion.linear() = ExpSo3(omega);
  motion.translation() = translation;
  return motion;
}

DeformationGraph CoverWithNodes(const TriangleMesh& mesh, double spacing) {
  DeformationGraph graph;
  graph.node_spacing = spacing;
  GrowGraph(mesh, GraphOptions(), &graph, nullptr);
  return graph;
}

DeformationGraph PlateGraph() {
  return CoverWithNodes(PlateMesh(0.2, 0.1, 0.01, 1), 0.04);
}

void Shake(double size, std::uint32_t seed, DeformationGraph* graph) {
  std::mt19937 random(seed);
  for (NodeMotion& motion : graph->motions) {
    motion.rotation = ExpSo3(RandomVector(size, &random)) * motion.rotation;
    motion.translation += RandomVector(size, &random);
  }
}

void MoveNodes(
    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map,
    DeformationGraph* graph) {
  constexpr double kStep = 1e-5;  // Metres.
  for (int i = 0; i < graph->size(); ++i) {
    const Eigen::Vector3d& g = graph->positions[i];
    Eigen::Matrix3d derivative;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      derivative.col(axis) = (map(g + step) - map(g - step)) / (2 * kStep);
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
        derivative, Eigen::ComputeFullU | Eigen::ComputeFullV);
    graph->motions[i].rotation = svd.matrixU() * svd.matrixV().transpose();
    graph->motions[i].translation = map(g) - g;
  }
}

Eigen::Vector3d Bend(const Eigen::Vector3d& p, double z, double curvature) {
  const double angle = curvature * p.x();
  const double radius = 1 / curvature;
  return {(radius + z - p.z()) * std::sin(angle), p.y(),
          z + radius - (radius + z - p.z()) * std::cos(angle)};
}

std::vector<std::vector<double>> RandomTwists(int count, double size,
                                              std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::vector<double>> twists(count, std::vector<double>(6));
  for (std::vector<double>& twist : twists) {
    for (double& value : twist) value = Uniform(size, &random);
  }
  return twists;
}

}  // namespace splitfusion
