#include "splitfusion/lib/energy/warped_points.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>

namespace splitfusion {
namespace {

/// Nodes of a sample, compact for sorting.
struct NodeKey {
  std::array<std::int32_t, kMaxSkinningNodes> nodes;
  int count;
  int sample;

  bool SameNodes(const NodeKey& other) const {
    return count == other.count &&
           std::equal(nodes.begin(), nodes.begin() + count,
                      other.nodes.begin());
  }
  bool operator<(const NodeKey& other) const {
    const int common = std::min(count, other.count);
    for (int k = 0; k < common; ++k) {
      if (nodes[k] != other.nodes[k]) return nodes[k] < other.nodes[k];
    }
    return count != other.count ? count < other.count : sample < other.sample;
  }
};

/// Keys in ascending order: by first node in one pass, then within.
std::vector<NodeKey> SortedKeys(
    const std::vector<const ModelSample*>& samples) {
  int nodes = 0;
  for (const ModelSample* sample : samples) {
    nodes = std::max(nodes, sample->skinning.nodes[0] + 1);
  }
  std::vector<int> begin(nodes + 1, 0);
  for (const ModelSample* sample : samples) {
    ++begin[sample->skinning.nodes[0] + 1];
  }
  for (int i = 0; i < nodes; ++i) begin[i + 1] += begin[i];
  std::vector<NodeKey> keys(samples.size());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Skinning& skinning = samples[i]->skinning;
    keys[next[skinning.nodes[0]]++] = {skinning.nodes, skinning.count,
                                       static_cast<int>(i)};
  }
  for (int i = 0; i < nodes; ++i) {
    if (std::is_sorted(&keys[begin[i]],
                       &keys[begin[i]] + begin[i + 1] - begin[i])) {
      continue;
    }
    std::sort(keys.begin() + begin[i], keys.begin() + begin[i + 1]);
  }
  return keys;
}

}  // namespace

TwistedNode TwistNode(const DeformationGraph& graph, int node,
                      const double* twist) {
  using Jet3 = ceres::Jet<double, 3>;
  const Jet3 omega[3] = {{twist[0], 0}, {twist[1], 1}, {twist[2], 2}};
  Jet3 jets[9];
  ceres::AngleAxisToRotationMatrix(omega, jets);  // Column-major.
  Eigen::Matrix3d exp, derivative[3];
  for (int e = 0; e < 9; ++e) {
    exp.data()[e] = jets[e].a;
    for (int d = 0; d < 3; ++d) derivative[d].data()[e] = jets[e].v[d];
  }
  TwistedNode twisted;
  const NodeMotion& motion = graph.motions[node];
  twisted.rotation = exp * motion.rotation;
  twisted.rest = graph.positions[node];
  twisted.offset = motion.translation + graph.positions[node] +
                   Eigen::Map<const Eigen::Vector3d>(twist + 3);
  for (int d = 0; d < 3; ++d) {
    // d exp = [J e_d]x exp, a cross product matrix.
    const Eigen::Matrix3d cross = derivative[d] * exp.transpose();
    twisted.spin_transposed.row(d) << cross(2, 1), cross(0, 2), cross(1, 0);
  }
  return twisted;
}

WarpedPoints::WarpedPoints(const std::vector<const ModelSample*>& samples) {
  const std::vector<NodeKey> keys = SortedKeys(samples);
  std::size_t weights = 0;
  for (const NodeKey& key : keys) weights += key.count;
  source_.reserve(keys.size());
  points_.reserve(3 * keys.size());
  weights_.reserve(weights);
  nodes_.reserve(weights);
  for (const NodeKey& key : keys) {
    const ModelSample& sample = *samples[key.sample];
    const int at = static_cast<int>(source_.size());
    if (groups_.empty() || !key.SameNodes(keys[at - 1]) ||
        at - groups_.back().begin == kMaxGroupSize) {
      groups_.push_back({at, at, nodes_.data() + nodes_.size(), key.count,
                         weights_.data() + weights_.size()});
      nodes_.insert(nodes_.end(), key.nodes.begin(),
                    key.nodes.begin() + key.count);
    }
    ++groups_.back().end;
    source_.push_back(key.sample);
    for (int d = 0; d < 3; ++d) points_.push_back(sample.point[d]);
    for (int k = 0; k < key.count; ++k) {
      weights_.push_back(sample.skinning.weights[k]);
    }
  }
}

void WarpedPoints::Warp(const Group& group, int begin, int end,
                        const TwistedNode* const* nodes, double* warped,
                        double* carried) const {
  const double* weights =
      group.weights + (begin - group.begin) * group.node_count;
  for (int i = begin; i < end; ++i) {
    const Eigen::Vector3d point(&points_[3 * i]);
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    for (int k = 0; k < group.node_count; ++k, carried += 3) {
      const TwistedNode& node = *nodes[k];
      const Eigen::Vector3d p = node.rotation * (point - node.rest);
      Eigen::Vector3d::Map(carried) = p;
      x += *weights++ * (p + node.offset);
    }
    Eigen::Vector3d::Map(warped + 3 * (i - begin)) = x;
  }
}

void WarpedPoints::DifferentiateByTwists(const Group& group, int point,
                                         const TwistedNode* const* nodes,
                                         const double* carried,
                                         const double* by_point,
                                         double* row) const {
  const Eigen::Vector3d b(by_point);
  const double* weights =
      group.weights + (point - group.begin) * group.node_count;
  for (int k = 0; k < group.node_count; ++k, carried += 3, row += kTwistSize) {
    const Eigen::Vector3d weighted = weights[k] * b;
    const Eigen::Vector3d p(carried);
    Eigen::Vector3d::Map(row) = nodes[k]->spin_transposed * p.cross(weighted);
    Eigen::Vector3d::Map(row + 3) = weighted;
  }
}

std::shared_ptr<const WarpedPoints> WarpedPointsCache::Get(
    const std::vector<const ModelSample*>& samples) {
  for (const auto& [known, points] : entries_) {
    if (known == samples) return points;
  }
  entries_.emplace_back(samples, std::make_shared<WarpedPoints>(samples));
  return entries_.back().second;
}

}  // namespace splitfusion
