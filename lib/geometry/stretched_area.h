#ifndef SPLITFUSION_LIB_GEOMETRY_STRETCHED_AREA_H_
#define SPLITFUSION_LIB_GEOMETRY_STRETCHED_AREA_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Edges longer than this are stretched, metres: a triangle of a new mesh has
/// edges no longer than 1.8 voxels.
constexpr double kStretchedEdge = 0.03;

/// Triangles that join what does not hang together: they lie between parts of
/// a surface that touched in the canonical frame (a hand at the hip, the legs
/// of somebody who stands), and span the gap where these have moved apart.
struct StretchedArea {
  double area = 0;          ///< Of all triangles, square metres.
  double stretched = 0;     ///< Of those with a stretched edge.
  int triangles = 0;        ///< Number of these.
  double longest_edge = 0;  ///< Metres.

  /// `stretched` / `area`; 0 without area.
  double Share() const { return area > 0 ? stretched / area : 0; }

  /// Adds those of another mesh.
  StretchedArea& operator+=(const StretchedArea& other);
};

/// Length from which on an edge of a warped mesh is stretched, metres, given
/// the canonical mesh: kStretchedEdge, or where voxels are coarse twice the
/// longest edge there is.
double StretchedFrom(const TriangleMesh& canonical);

/// Those of the triangles that have an edge longer than `length`, where their
/// vertices are `warped`; metres.
std::vector<Eigen::Vector3i> StretchedTriangles(
    double length, const std::vector<Eigen::Vector3i>& triangles,
    const std::vector<Eigen::Vector3f>& warped);

/// Takes the triangles with an edge longer than `length` out of a warped mesh
/// (metres), and returns what there was; the vertices stay.
StretchedArea CutStretched(double length, TriangleMesh* mesh);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_STRETCHED_AREA_H_
