#ifndef SPLITFUSION_LIB_GEOMETRY_TRIANGLE_TREE_H_
#define SPLITFUSION_LIB_GEOMETRY_TRIANGLE_TREE_H_

#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace splitfusion {

/// The point of a triangle set that is nearest to a query point.
struct SurfacePoint {
  int triangle = -1;   ///< Index into the tree's triangles; -1 = none in reach.
  float distance = 0;  ///< To the query point, metres.
  /// Weights of the triangle's three corners, sum 1, each >= 0.
  Eigen::Vector3f barycentric = Eigen::Vector3f::Zero();
};

/// Exact point-to-triangle search over fixed triangles: a binary tree of
/// bounding boxes, cut at the median of the longest side. Triangles may be
/// degenerate (a point is one). Queries are thread-safe.
class TriangleTree {
 public:
  /// Copies the triangles (metres); there may be none.
  TriangleTree(const std::vector<Eigen::Vector3f>& vertices,
               const std::vector<Eigen::Vector3i>& triangles);

  /// Nearest point nearer than `max_distance` (metres).
  SurfacePoint Closest(const Eigen::Vector3f& query, float max_distance) const;

 private:
  struct Item {
    std::array<Eigen::Vector3f, 3> corners;
    int triangle;
  };
  struct Node {
    Eigen::AlignedBox3f box;
    int begin = 0;  // Items of a leaf: [begin, end).
    int end = 0;
    int right = 0;  // Second child; the first follows its parent. 0 = leaf.
  };

  int Build(int begin, int end);

  std::vector<Item> items_;
  std::vector<Node> nodes_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_TRIANGLE_TREE_H_
