#include "splitfusion/lib/geometry/nearest_point.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace splitfusion {
namespace {

constexpr int kLeafPoints = 8;         // Speed: at most.
constexpr int kParallelPoints = 4096;  // Speed: worth a task.

/// Axis along which the points reach farthest.
int WidestAxis(const std::vector<Eigen::Vector3f>& points, const int* begin,
               const int* end) {
  Eigen::Vector3f low = points[*begin], high = low;
  for (const int* i = begin; i != end; ++i) {
    low = low.cwiseMin(points[*i]);
    high = high.cwiseMax(points[*i]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  return axis;
}

}  // namespace

/// A query on its way through the tree.
struct NearestPoint::Search {
  float query[3];
  float offset[3] = {0, 0, 0};  // From the query to the cell, by axis.
  float squared = std::numeric_limits<float>::max();
  int index = std::numeric_limits<int>::max();

  float SquaredOffset() const {
    return offset[0] * offset[0] + offset[1] * offset[1] +
           offset[2] * offset[2];
  }
};

NearestPoint::NearestPoint(const std::vector<Eigen::Vector3f>& points)
    : count_(static_cast<int>(points.size())) {
  while ((count_ >> levels_) >= kLeafPoints) ++levels_;
  splits_.resize((std::size_t{1} << levels_) - 1);
  index_.resize(points.size());
  std::iota(index_.begin(), index_.end(), 0);
  Build(0, 0, 0, count_, &index_, points);
  place_.resize(points.size());
  for (auto& row : coordinates_) row.resize(points.size());
  for (int i = 0; i < count_; ++i) {
    place_[index_[i]] = i;
    for (int axis = 0; axis < 3; ++axis) {
      coordinates_[axis][i] = points[index_[i]][axis];
    }
  }
}

int NearestPoint::LeafBegin(int leaf) const {
  return static_cast<int>((static_cast<std::int64_t>(leaf) * count_) >>
                          levels_);
}

void NearestPoint::Build(int node, int level, int begin, int end,
                         std::vector<int>* order,
                         const std::vector<Eigen::Vector3f>& points) {
  if (level == levels_) return;
  // Where the first leaf of the right child begins.
  const int right = 2 * node + 2;
  const int first_of_level = (1 << (level + 1)) - 1;
  const int middle =
      LeafBegin((right - first_of_level) << (levels_ - level - 1));
  const auto at = order->begin();
  Split& split = splits_[node];
  split.axis = WidestAxis(points, &*at + begin, &*at + end);
  std::nth_element(at + begin, at + middle, at + end, [&](int a, int b) {
    return points[a][split.axis] < points[b][split.axis];
  });
  split.value = points[(*order)[middle]][split.axis];
  const auto build_left = [&] {
    Build(2 * node + 1, level + 1, begin, middle, order, points);
  };
  const auto build_right = [&] {
    Build(right, level + 1, middle, end, order, points);
  };
  if (end - begin > kParallelPoints) {
    tbb::parallel_invoke(build_left, build_right);
  } else {
    build_left();
    build_right();
  }
}

void NearestPoint::Scan(int leaf, Search* search) const {
  const int end = LeafBegin(leaf + 1);
  for (int i = LeafBegin(leaf); i < end; ++i) {
    const float dx = search->query[0] - coordinates_[0][i];
    const float dy = search->query[1] - coordinates_[1][i];
    const float dz = search->query[2] - coordinates_[2][i];
    const float squared = dx * dx + dy * dy + dz * dz;
    if (squared > search->squared) continue;
    if (squared < search->squared || index_[i] < search->index) {
      search->squared = squared;
      search->index = index_[i];
    }
  }
}

void NearestPoint::Descend(int node, int level, Search* search) const {
  if (level == levels_) {
    Scan(node - ((1 << levels_) - 1), search);
    return;
  }
  const Split& split = splits_[node];
  const float offset = search->query[split.axis] - split.value;
  const int left = 2 * node + 1;
  Descend(offset < 0 ? left : left + 1, level + 1, search);
  // No point of the far side is nearer than its wall, rounding included: the
  // same operations on numbers that are no smaller.
  const float before = search->offset[split.axis];
  search->offset[split.axis] = offset;
  if (search->SquaredOffset() <= search->squared) {
    Descend(offset < 0 ? left + 1 : left, level + 1, search);
  }
  search->offset[split.axis] = before;
}

int NearestPoint::Find(const Eigen::Vector3f& query, int hint,
                       float* distance) const {
  Search search;
  for (int axis = 0; axis < 3; ++axis) search.query[axis] = query[axis];
  if (hint >= 0) {
    const int place = place_[hint];
    const float dx = query.x() - coordinates_[0][place];
    const float dy = query.y() - coordinates_[1][place];
    const float dz = query.z() - coordinates_[2][place];
    search.squared = dx * dx + dy * dy + dz * dz;
    search.index = hint;
  }
  Descend(0, 0, &search);
  if (distance != nullptr) *distance = std::sqrt(search.squared);
  return search.index;
}

}  // namespace splitfusion
