#include "splitfusion/lib/geometry/stretched_area.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "splitfusion/lib/geometry/triangle_corners.h"

namespace splitfusion {

StretchedArea& StretchedArea::operator+=(const StretchedArea& other) {
  area += other.area;
  stretched += other.stretched;
  triangles += other.triangles;
  longest_edge = std::max(longest_edge, other.longest_edge);
  return *this;
}

double StretchedFrom(const TriangleMesh& canonical) {
  double longest = 0;
  for (const Eigen::Vector3i& triangle : canonical.triangles) {
    longest = std::max<double>(
        longest, TriangleCorners(canonical, triangle).LongestEdge());
  }
  return std::max(kStretchedEdge, 2 * longest);
}

std::vector<Eigen::Vector3i> StretchedTriangles(
    double length, const std::vector<Eigen::Vector3i>& triangles,
    const std::vector<Eigen::Vector3f>& warped) {
  std::vector<Eigen::Vector3i> stretched;
  for (const Eigen::Vector3i& triangle : triangles) {
    if (TriangleCorners(warped, triangle).LongestEdge() > length) {
      stretched.push_back(triangle);
    }
  }
  return stretched;
}

StretchedArea CutStretched(double length, TriangleMesh* mesh) {
  StretchedArea result;
  const auto is_stretched = [&](const Eigen::Vector3i& triangle) {
    const TriangleCorners corners(*mesh, triangle);
    const double area = corners.Area();
    const double longest = corners.LongestEdge();
    result.area += area;
    result.longest_edge = std::max(result.longest_edge, longest);
    if (longest <= length) return false;
    result.stretched += area;
    ++result.triangles;
    return true;
  };
  std::vector<Eigen::Vector3i>& all = mesh->triangles;
  std::vector<Eigen::Vector3i> kept;
  kept.reserve(all.size());
  for (const Eigen::Vector3i& triangle : all) {
    if (!is_stretched(triangle)) kept.push_back(triangle);
  }
  all = std::move(kept);
  return result;
}

}  // namespace splitfusion
