#include "splitfusion/lib/deformation/skinning.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kMaxCandidates = 128;

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

/// Nodes within two edges of `node`, at least `wanted` of them if the graph
/// has so many (small islands of the graph borrow from their surroundings).
std::vector<int> Candidates(const DeformationGraph& graph, const KdTree& tree,
                            int node, int wanted) {
  std::vector<int> found = {node};
  for (const int j : graph.neighbors[node]) {
    found.push_back(j);
    found.insert(found.end(), graph.neighbors[j].begin(),
                 graph.neighbors[j].end());
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (static_cast<int>(found.size()) < std::min(wanted, graph.size())) {
    const std::vector<int> nearest =
        tree.Nearest(graph.positions[node].cast<float>(), wanted);
    found.insert(found.end(), nearest.begin(), nearest.end());
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }
  if (found.size() > kMaxCandidates) KeepNearest(graph, node, &found);
  return found;
}

}  // namespace

SkinningIndex::SkinningIndex(const DeformationGraph& graph,
                             int neighbors_per_point)
    : k_(neighbors_per_point),
      positions_(ToFloat(graph.positions)),
      tree_(positions_) {
  CheckOption(k_ >= 1 && k_ <= kMaxSkinningNodes, "neighbors_per_point", k_,
              "1.." + std::to_string(kMaxSkinningNodes));
  candidates_.resize(graph.size());
  for (int i = 0; i < graph.size(); ++i) {
    candidates_[i] = Candidates(graph, tree_, i, k_ + 1);
  }
}

Skinning SkinningIndex::Skin(const Eigen::Vector3f& point) const {
  Skinning skinning;
  if (positions_.size() == 1) {
    skinning.count = 1;
    skinning.weights[0] = 1;
    return skinning;
  }
  const std::vector<int>& candidates = candidates_[NearestNode(point, nullptr)];
  std::array<std::pair<float, int>, kMaxCandidates> order;
  int count = 0;
  for (const int node : candidates) {
    order[count++] = {(positions_[node] - point).squaredNorm(), node};
  }
  const int used = std::min(k_, count);
  const int sorted = std::min(used + 1, count);
  std::partial_sort(order.begin(), order.begin() + sorted,
                    order.begin() + count);
  const float farthest = std::sqrt(order[sorted - 1].first);
  const float d_max = count > used ? farthest : 2 * farthest;
  std::sort(order.begin(), order.begin() + used,
            [](const auto& a, const auto& b) { return a.second < b.second; });
  float sum = 0;
  for (int k = 0; k < used; ++k) {
    // The floor keeps the sum positive where all nodes are equally far.
    const float closeness = 1 - std::sqrt(order[k].first) / d_max;
    const float weight = std::max(closeness * closeness, 1e-8f);
    skinning.nodes[skinning.count] = order[k].second;
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
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        skinnings[i] = Skin(points[i]);
                      }
                    });
  return skinnings;
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
