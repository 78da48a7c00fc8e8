#ifndef SPLITFUSION_LIB_GEOMETRY_KD_TREE_H_
#define SPLITFUSION_LIB_GEOMETRY_KD_TREE_H_

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace splitfusion {

/// Nearest-neighbour search among fixed points of space (FLANN through PCL).
/// Queries are thread-safe.
class KdTree {
 public:
  /// Copies the points (metres); there must be at least one.
  explicit KdTree(const std::vector<Eigen::Vector3f>& points);
  ~KdTree();
  /// Takes the tree over.
  KdTree(KdTree&&) noexcept;
  /// Takes the tree over.
  KdTree& operator=(KdTree&&) noexcept;

  /// Whether a point is nearer than `distance` (metres).
  bool HasNear(const Eigen::Vector3f& query, double distance) const;

  /// Indices of the `count` nearest points (fewer if there are not so many),
  /// nearest first.
  std::vector<int> Nearest(const Eigen::Vector3f& query, int count) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_KD_TREE_H_
