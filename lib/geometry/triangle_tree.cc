#include "splitfusion/lib/geometry/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace splitfusion {
namespace {

constexpr int kLeafSize = 4;   // Speed.
constexpr int kMaxDepth = 64;  // Layout.

using Corners = std::array<Eigen::Vector3f, 3>;

/// Weights of the corners at the point of a triangle nearest to p (Ericson,
/// Real-Time Collision Detection, 5.1.5): the regions of the corners, of the
/// edges, and the inside are told apart by the signs of scalar products. An
/// edge without length has no region, so that a triangle with two equal corners
/// is the segment that it is. Not finite if rounding leaves a needle no area.
Eigen::Vector3f ClosestWeights(const Eigen::Vector3f& p, const Corners& t) {
  const Eigen::Vector3f ab = t[1] - t[0];
  const Eigen::Vector3f ac = t[2] - t[0];
  const float d1 = ab.dot(p - t[0]);
  const float d2 = ac.dot(p - t[0]);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const float d3 = ab.dot(p - t[1]);
  const float d4 = ac.dot(p - t[1]);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) {
    const float v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const float d5 = ab.dot(p - t[2]);
  const float d6 = ac.dot(p - t[2]);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) {
    const float w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  return Eigen::Vector3f(va, vb, vc) / (va + vb + vc);
}

}  // namespace

TriangleTree::TriangleTree(const std::vector<Eigen::Vector3f>& vertices,
                           const std::vector<Eigen::Vector3i>& triangles) {
  items_.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Eigen::Vector3i& t = triangles[i];
    items_.push_back({{vertices[t[0]], vertices[t[1]], vertices[t[2]]},
                      static_cast<int>(i)});
  }
  nodes_.reserve(items_.size());
  if (!items_.empty()) Build(0, static_cast<int>(items_.size()));
}

int TriangleTree::Build(int begin, int end) {
  Eigen::AlignedBox3f box;
  Eigen::AlignedBox3f centers;
  const auto center = [](const Item& item) -> Eigen::Vector3f {
    return item.corners[0] + item.corners[1] + item.corners[2];
  };
  for (int i = begin; i < end; ++i) {
    for (const Eigen::Vector3f& corner : items_[i].corners) box.extend(corner);
    centers.extend(center(items_[i]));
  }
  const int index = static_cast<int>(nodes_.size());
  nodes_.push_back({box, begin, end, 0});
  if (end - begin <= kLeafSize) return index;
  int axis = 0;
  centers.sizes().maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle,
                   items_.begin() + end, [&](const Item& a, const Item& b) {
                     return std::make_pair(center(a)[axis], a.triangle) <
                            std::make_pair(center(b)[axis], b.triangle);
                   });
  Build(begin, middle);
  const int right = Build(middle, end);
  nodes_[index].right = right;
  return index;
}

SurfacePoint TriangleTree::Closest(const Eigen::Vector3f& query,
                                   float max_distance) const {
  SurfacePoint best;
  if (nodes_.empty()) return best;
  float best_squared = max_distance * max_distance;
  std::array<std::pair<float, int>, kMaxDepth> stack;
  int size = 0;
  const auto push = [&](int node) {
    const float squared = nodes_[node].box.squaredExteriorDistance(query);
    if (squared < best_squared) stack[size++] = {squared, node};
  };
  push(0);
  while (size > 0) {
    const auto [squared, index] = stack[--size];
    if (squared >= best_squared) continue;
    const Node& node = nodes_[index];
    if (node.right != 0) {
      push(index + 1);
      push(node.right);
      // The nearer child is looked at first.
      if (size >= 2 && stack[size - 2].second == index + 1 &&
          stack[size - 2].first < stack[size - 1].first) {
        std::swap(stack[size - 2], stack[size - 1]);
      }
      continue;
    }
    for (int i = node.begin; i < node.end; ++i) {
      const Corners& t = items_[i].corners;
      const Eigen::Vector3f w = ClosestWeights(query, t);
      const Eigen::Vector3f nearest = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
      const float distance_squared = (query - nearest).squaredNorm();
      // Refuses also a distance that is not a number.
      if (!(distance_squared < best_squared)) continue;
      best_squared = distance_squared;
      best.triangle = items_[i].triangle;
      best.barycentric = w;
    }
  }
  best.distance = best.triangle >= 0 ? std::sqrt(best_squared) : 0;
  return best;
}

}  // namespace splitfusion
