#include "splitfusion/lib/geometry/kd_tree.h"

#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>

#include <algorithm>

namespace splitfusion {

struct KdTree::Impl {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree{/*sorted=*/true};
  int size = 0;
};

KdTree::KdTree(const std::vector<Eigen::Vector3f>& points)
    : impl_(std::make_unique<Impl>()) {
  auto cloud = pcl::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points.size());
  for (const Eigen::Vector3f& p : points) {
    cloud->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
  }
  impl_->size = static_cast<int>(points.size());
  impl_->tree.setInputCloud(cloud);
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

bool KdTree::HasNear(const Eigen::Vector3f& query, double distance) const {
  thread_local pcl::Indices index;
  thread_local std::vector<float> squared;
  return impl_->tree.radiusSearch(
             pcl::PointXYZ(query.x(), query.y(), query.z()), distance, index,
             squared, 1) > 0;
}

std::vector<int> KdTree::Nearest(const Eigen::Vector3f& query,
                                 int count) const {
  pcl::Indices indices;
  std::vector<float> squared;
  impl_->tree.nearestKSearch(pcl::PointXYZ(query.x(), query.y(), query.z()),
                             std::min(count, impl_->size), indices, squared);
  return {indices.begin(), indices.end()};
}

}  // namespace splitfusion
