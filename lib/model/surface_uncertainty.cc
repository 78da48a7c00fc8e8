#include "splitfusion/lib/model/surface_uncertainty.h"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "splitfusion/lib/energy/node_covariance.h"

namespace splitfusion {
namespace {

/// Vertices as the problem has them. A rigid surface is solved for the motion
/// of what already lies in the camera frame, see SurfaceTracker.
std::vector<Eigen::Vector3f> PointsOfProblem(
    const Surface& surface, const DeformationGraph& solution,
    const std::vector<Eigen::Vector3f>& warped) {
  if (!solution.rigid()) return surface.mesh().vertices;
  const Eigen::Matrix3d turned_back = solution.motions[0].rotation.transpose();
  const Eigen::Vector3d& g = solution.positions[0];
  const Eigen::Vector3d moved_to = g + solution.motions[0].translation;
  std::vector<Eigen::Vector3f> points;
  points.reserve(warped.size());
  for (const Eigen::Vector3f& x : warped) {
    points.push_back(
        (turned_back * (x.cast<double>() - moved_to) + g).cast<float>());
  }
  return points;
}

/// The direction in which a point is known least, as long as its standard
/// deviation along it, metres; away from the camera.
Eigen::Vector3d WeakestDirection(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d weakest =
      solver.eigenvectors().col(2) *
      std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
  return weakest.z() < 0 ? Eigen::Vector3d(-weakest) : weakest;
}

}  // namespace

std::vector<double> SurfaceUncertainty::Sigmas() const {
  std::vector<double> sigmas;
  sigmas.reserve(covariances.size());
  for (const Eigen::Matrix3d& covariance : covariances) {
    sigmas.push_back(std::sqrt(covariance.trace() / 3));
  }
  return sigmas;
}

SurfaceUncertainty EstimateUncertainty(const Surface& surface,
                                       const SolvedProblem& solved) {
  const DeformationGraph& graph = solved.problem.graph;
  SurfaceUncertainty result;
  result.mesh.vertices = surface.WarpedVertices();
  result.mesh.colors = surface.mesh().colors;
  result.mesh.triangles = surface.mesh().triangles;
  const std::vector<Eigen::Vector3f> points =
      PointsOfProblem(surface, graph, result.mesh.vertices);
  const std::vector<Skinning> skinnings =
      SkinningIndex(graph, surface.graph_options().neighbors_per_point)
          .Skin(points);
  const NodeCovariance covariance(solved.View(), graph, skinnings);
  result.nodes = graph.size();
  result.held_by_prior = static_cast<int>(covariance.held_by_prior().size());
  result.covariances.resize(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    result.covariances[i] = covariance.OfPoint(skinnings[i], points[i]);
  });
  return result;
}

void WriteUncertainty(const std::string& path,
                      const SurfaceUncertainty& uncertainty) {
  PlyProperties properties;
  properties["sigma"] = uncertainty.Sigmas();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double>& sigma =
        properties[std::string("sigma_") + "xyz"[axis]];
    std::vector<double>& weakest =
        properties[std::string("weakest_") + "xyz"[axis]];
    for (const Eigen::Matrix3d& covariance : uncertainty.covariances) {
      sigma.push_back(std::sqrt(covariance(axis, axis)));
      weakest.push_back(WeakestDirection(covariance)[axis]);
    }
  }
  WritePly(path, uncertainty.mesh, properties);
}

}  // namespace splitfusion
