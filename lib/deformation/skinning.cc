#include "splitfusion/lib/deformation/skinning.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kMaxCandidates = 128;  // Speed.

/// The few nearest of the nodes shown to it, nearest first, the lower index
/// among equals.
class NearestFew {
 public:
  explicit NearestFew(int size) : size_(size) {
    entries_.fill({std::numeric_limits<float>::max(), -1});
  }

  void Insert(float squared, int node) {
    const std::pair<float, int> entry(squared, node);
    if (!(entry < entries_[size_ - 1])) return;
    int i = size_ - 1;
    for (; i > 0 && entry < entries_[i - 1]; --i) entries_[i] = entries_[i - 1];
    entries_[i] = entry;
    reach_ = std::sqrt(FarthestSquared());
  }

  /// No node farther than this from a place `distance` away from the point can
  /// be among the few, rounding included.
  float Reach(float distance) const {
    return 1.0001f * (reach_ + distance);  // Maths.
  }

  float FarthestSquared() const { return entries_[size_ - 1].first; }
  float squared(int i) const { return entries_[i].first; }
  int node(int i) const { return entries_[i].second; }

  /// Orders the first `count` entries by their nodes.
  void SortByNode(int count) {
    std::sort(entries_.begin(), entries_.begin() + count,
              [](const auto& a, const auto& b) { return a.second < b.second; });
  }

 private:
  int size_;
  float reach_ = std::numeric_limits<float>::max();
  std::array<std::pair<float, int>, kMaxSkinningNodes + 1> entries_;
};

/// Orders candidates by their distance from node `center`.
void SortByDistance(const std::vector<Eigen::Vector3f>& positions, int center,
                    std::vector<int>* nodes) {
  std::vector<std::pair<float, int>> order;
  for (const int node : *nodes) {
    order.emplace_back((positions[node] - positions[center]).norm(), node);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) (*nodes)[i] = order[i].second;
}

std::vector<Eigen::Vector3f> ToFloat(const std::vector<Eigen::Vector3d>& in) {
  std::vector<Eigen::Vector3f> out;
  out.reserve(in.size());
  for (const Eigen::Vector3d& p : in) out.push_back(p.cast<float>());
  return out;
}

/// Cuts ascending candidates down to the kMaxCandidates nearest to `node`.
void KeepNearest(const DeformationGraph& graph, int node,
                 std::vector<int>* candidates) {
  const auto distance = [&](int i) {
    return (graph.positions[i] - graph.positions[node]).squaredNorm();
  };
  std::stable_sort(candidates->begin(), candidates->end(),
                   [&](int a, int b) { return distance(a) < distance(b); });
  candidates->resize(kMaxCandidates);
  std::sort(candidates->begin(), candidates->end());
}

/// Nodes within two edges of `node`, ascending; within more edges where these
/// are fewer than `wanted`, as at the end of a chain.
std::vector<int> Candidates(const DeformationGraph& graph, int node,
                            std::size_t wanted) {
  std::vector<int> found = {node};
  std::size_t ring = 0;  // Where the nodes of the last ring begin.
  for (int edges = 1; ring < found.size(); ++edges) {
    if (edges > 2 && found.size() >= wanted) break;
    const std::size_t end = found.size();
    for (; ring < end; ++ring) {
      for (const int j : graph.neighbors[found[ring]]) {
        if (std::find(found.begin(), found.end(), j) == found.end()) {
          found.push_back(j);
        }
      }
    }
  }
  std::sort(found.begin(), found.end());
  if (found.size() > kMaxCandidates) KeepNearest(graph, node, &found);
  return found;
}

}  // namespace

SkinningIndex::SkinningIndex(const DeformationGraph& graph,
                             int neighbors_per_point)
    : k_(neighbors_per_point),
      node_count_(graph.size()),
      tree_(ToFloat(graph.positions)) {
  CheckOption(k_ >= 1 && k_ <= kMaxSkinningNodes, "neighbors_per_point", k_,
              "1.." + std::to_string(kMaxSkinningNodes));
  const std::vector<Eigen::Vector3f> positions = ToFloat(graph.positions);
  candidates_.resize(graph.size());
  tbb::parallel_for(0, graph.size(), [&](int i) {
    CandidateList& list = candidates_[i];
    list.nodes = Candidates(graph, i, k_ + 1);
    SortByDistance(positions, i, &list.nodes);
    for (const int node : list.nodes) {
      list.x.push_back(positions[node].x());
      list.y.push_back(positions[node].y());
      list.z.push_back(positions[node].z());
      list.distance.push_back((positions[node] - positions[i]).norm());
    }
  });
}

Skinning SkinningIndex::Skin(const Eigen::Vector3f& point) const {
  SkinningSupport support;
  return Skin(point, &support);
}

Skinning SkinningIndex::Skin(const Eigen::Vector3f& point,
                             SkinningSupport* support) const {
  float distance = 0;
  support->nearest = tree_.Find(point, support->nearest, &distance);
  support->distance = distance;
  support->reach = std::numeric_limits<float>::infinity();
  Skinning skinning;
  if (node_count_ == 1) {
    skinning.count = 1;
    skinning.weights[0] = 1;
    return skinning;
  }
  const CandidateList& list = candidates_[support->nearest];
  const int count = static_cast<int>(list.nodes.size());
  const int used = std::min(k_, count);
  NearestFew few(std::min(used + 1, count));
  for (int i = 0; i < count; ++i) {
    // By the triangle inequality all that follow are farther than those found.
    if (list.distance[i] > few.Reach(distance)) break;
    const float dx = list.x[i] - point.x();
    const float dy = list.y[i] - point.y();
    const float dz = list.z[i] - point.z();
    few.Insert(dx * dx + (dy * dy + dz * dz), list.nodes[i]);
  }
  if (count > used) support->reach = few.Reach(distance);
  const float farthest = std::sqrt(few.FarthestSquared());
  const float d_max = count > used ? farthest : 2 * farthest;
  few.SortByNode(used);
  float sum = 0;
  for (int k = 0; k < used; ++k) {
    // The floor keeps the sum positive where all nodes are equally far, and is
    // taken for 0 / 0 where a point lies on the one node that may carry it.
    const float closeness = 1 - std::sqrt(few.squared(k)) / d_max;
    const float weight = std::fmax(closeness * closeness, 1e-8f);
    skinning.nodes[skinning.count] = few.node(k);
    skinning.weights[skinning.count++] = weight;
    sum += weight;
  }
  for (int k = 0; k < skinning.count; ++k) skinning.weights[k] /= sum;
  return skinning;
}

std::vector<Skinning> SkinningIndex::Skin(
    const std::vector<Eigen::Vector3f>& points) const {
  std::vector<Skinning> skinnings(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      SkinningSupport support;
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        skinnings[i] = Skin(points[i], &support);
                      }
                    });
  return skinnings;
}

float SkinningIndex::FirstDifference(const SkinningIndex& before,
                                     const SkinningIndex& after,
                                     const std::vector<int>& numbers,
                                     int node) {
  if (numbers[node] < 0) return 0;
  // Both are in the order of their distances.
  const CandidateList& a = before.candidates_[node];
  const CandidateList& b = after.candidates_[numbers[node]];
  const auto [i, j] = std::mismatch(
      a.nodes.begin(), a.nodes.end(), b.nodes.begin(), b.nodes.end(),
      [&](int old, int now) { return numbers[old] == now; });
  float first = std::numeric_limits<float>::infinity();
  if (i != a.nodes.end()) first = a.distance[i - a.nodes.begin()];
  if (j != b.nodes.end()) {
    first = std::min(first, b.distance[j - b.nodes.begin()]);
  }
  return first;
}

WarpField::WarpField(const DeformationGraph& graph) {
  maps_.reserve(graph.positions.size());
  for (int i = 0; i < graph.size(); ++i) {
    const NodeMotion& motion = graph.motions[i];
    const Eigen::Vector3d offset =
        ApplyNode(graph.positions[i], motion, Eigen::Vector3d::Zero());
    maps_.push_back({motion.rotation.cast<float>(), offset.cast<float>()});
  }
}

NodeMotion WarpField::BlendMotion(const Skinning& skinning,
                                  const Eigen::Vector3f& point) const {
  Eigen::Matrix3f blended = Eigen::Matrix3f::Zero();
  for (int k = 0; k < skinning.count; ++k) {
    blended += skinning.weights[k] * maps_[skinning.nodes[k]].linear;
  }
  NodeMotion motion;
  motion.rotation = Orthonormalized(blended.cast<double>());
  motion.translation = (WarpPoint(skinning, point) - point).cast<double>();
  return motion;
}

}  // namespace splitfusion
