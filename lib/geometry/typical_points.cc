#include "splitfusion/lib/geometry/typical_points.h"

#include <Eigen/Eigenvalues>

namespace splitfusion {

TypicalPoints TypicalPointsOf(const std::vector<Eigen::Vector3f>& points) {
  if (points.empty()) return TypicalPoints::Zero();
  const double count = static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& point : points) mean += point.cast<double>();
  mean /= count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3d off = point.cast<double>() - mean;
    covariance += off * off.transpose() / count;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
  const Eigen::Vector3d spread = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  TypicalPoints corners;  // Of a cube, every other one: a regular tetrahedron.
  corners << 1, 1, -1, -1,  //
      1, -1, 1, -1,         //
      1, -1, -1, 1;
  TypicalPoints typical = axes.eigenvectors() * spread.asDiagonal() * corners;
  typical.colwise() += mean;
  return typical;
}

}  // namespace splitfusion
