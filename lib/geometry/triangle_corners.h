#ifndef SPLITFUSION_LIB_GEOMETRY_TRIANGLE_CORNERS_H_
#define SPLITFUSION_LIB_GEOMETRY_TRIANGLE_CORNERS_H_

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Corners of a triangle of a mesh, metres.
struct TriangleCorners {
  Eigen::Vector3f a;  ///< First.
  Eigen::Vector3f b;  ///< Second.
  Eigen::Vector3f c;  ///< Third.

  /// Those of the triangle `t` of these vertices.
  TriangleCorners(const std::vector<Eigen::Vector3f>& vertices,
                  const Eigen::Vector3i& t)
      : a(vertices[t[0]]), b(vertices[t[1]]), c(vertices[t[2]]) {}
  /// Those of the mesh's triangle `t`.
  TriangleCorners(const TriangleMesh& mesh, const Eigen::Vector3i& t)
      : TriangleCorners(mesh.vertices, t) {}

  /// Twice the area, along the outward normal.
  Eigen::Vector3f Cross() const { return (b - a).cross(c - a); }
  /// Square metres.
  double Area() const { return 0.5 * Cross().norm(); }
  /// Metres.
  float LongestEdge() const {
    return std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  }
  /// Of the three.
  Eigen::Vector3f Middle() const { return (a + b + c) / 3; }
  /// Least z of the three.
  float Nearest() const { return std::min({a.z(), b.z(), c.z()}); }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_TRIANGLE_CORNERS_H_
