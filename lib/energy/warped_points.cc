#include "splitfusion/lib/energy/warped_points.h"

#include <ceres/jet.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <array>
#include <functional>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/option_list.h"

namespace splitfusion {
namespace {

/// Numbers past the end that the kernels may read.
constexpr int kReadTooFar = 3;  // Layout.

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

/// @throw InputError unless it is carried by nodes below `end`, ascending.
void CheckSample(const ModelSample* sample, int end) {
  // Of thousands: messages are made when one is wrong, not before.
  if (sample == nullptr) {
    throw OptionError("sample of a residual", "null", "a sample");
  }
  const Skinning& skinning = sample->skinning;
  const int count = skinning.count;
  if (count < 1 || count > kMaxSkinningNodes) {
    throw OptionError("nodes of a sample", std::to_string(count),
                      Range{1, kMaxSkinningNodes}.Text());
  }
  const int* nodes = skinning.nodes.data();
  CheckNodes(nodes, count, end);
  if (std::adjacent_find(nodes, nodes + count, std::greater_equal<>()) ==
      nodes + count) {
    return;
  }
  throw OptionError("nodes of a sample", NodesText(nodes, count),
                    "ascending nodes");
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
  const Eigen::Vector3d& g = graph.positions[node];
  Eigen::Matrix3d::Map(twisted.rotation) = exp * motion.rotation;
  Eigen::Vector3d::Map(twisted.rest) = g;
  Eigen::Vector3d::Map(twisted.offset) =
      motion.translation + g + Eigen::Vector3d::Map(twist + 3);
  for (int d = 0; d < 3; ++d) {
    // d exp = [J e_d]x exp, a cross product matrix.
    const Eigen::Matrix3d cross = derivative[d] * exp.transpose();
    Eigen::Matrix3d::Map(twisted.spin_transposed).row(d) << cross(2, 1),
        cross(0, 2), cross(1, 0);
  }
  return twisted;
}

WarpedPoints::WarpedPoints(const std::vector<const ModelSample*>& samples) {
  const std::vector<NodeKey> keys = SortedKeys(samples);
  std::size_t weights = 0;
  source_.reserve(keys.size());
  for (const NodeKey& key : keys) {
    const int at = static_cast<int>(source_.size());
    if (groups_.empty() || !key.SameNodes(keys[at - 1]) ||
        at - groups_.back().begin == kMaxGroupSize) {
      groups_.push_back({at, at, nullptr, key.count, nullptr, nullptr});
    }
    ++groups_.back().end;
    source_.push_back(key.sample);
    weights += key.count;
  }
  points_.resize(3 * keys.size() + kReadTooFar);
  weights_.resize(weights + kReadTooFar);
  nodes_.reserve(weights);
  double* next_weight = weights_.data();
  for (Group& group : groups_) {
    group.points = points_.data() + 3 * group.begin;
    group.weights = next_weight;
    group.nodes = nodes_.data() + nodes_.size();
    const auto& nodes = keys[group.begin].nodes;
    nodes_.insert(nodes_.end(), nodes.begin(),
                  nodes.begin() + group.node_count);
    FillGroup(samples, group, &points_[3 * group.begin], next_weight);
    next_weight += group.node_count * (group.end - group.begin);
  }
}

void WarpedPoints::FillGroup(const std::vector<const ModelSample*>& samples,
                             const Group& group, double* points,
                             double* weights) const {
  const int size = group.end - group.begin;
  for (int i = 0; i < size; ++i) {
    const ModelSample& sample = *samples[source_[group.begin + i]];
    for (int d = 0; d < 3; ++d) points[size * d + i] = sample.point[d];
    for (int k = 0; k < group.node_count; ++k) {
      weights[size * k + i] = sample.skinning.weights[k];
    }
  }
}

PointChunk WarpedPoints::Chunk(const Group& group, int begin, int end,
                               const TwistedNode* const* nodes) {
  const int first = begin - group.begin;
  return {nodes,
          group.node_count,
          end - begin,
          group.end - group.begin,
          group.points + first,
          group.weights + first};
}

bool WarpedPoints::AreOf(const std::vector<const ModelSample*>& samples) const {
  for (const Group& group : groups_) {
    const int size = group.end - group.begin;
    for (int i = 0; i < size; ++i) {
      const ModelSample& sample = *samples[source_[group.begin + i]];
      if (sample.skinning.count != group.node_count) return false;
      for (int d = 0; d < 3; ++d) {
        if (group.points[size * d + i] != sample.point[d]) return false;
      }
      for (int k = 0; k < group.node_count; ++k) {
        if (group.nodes[k] != sample.skinning.nodes[k] ||
            group.weights[size * k + i] != sample.skinning.weights[k]) {
          return false;
        }
      }
    }
  }
  return true;
}

std::string NodesText(const int* nodes, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) {
    text += (i == 0 ? "" : " ") + std::to_string(nodes[i]);
  }
  return count == 0 ? "none" : text;
}

void CheckNodes(const int* nodes, std::size_t count, int end) {
  const bool good = count > 0 && std::all_of(nodes, nodes + count, [=](int i) {
                      return 0 <= i && i < end;
                    });
  if (good) return;
  throw OptionError("nodes of a residual", NodesText(nodes, count),
                    "nodes of a graph of " + std::to_string(end));
}

std::shared_ptr<const WarpedPoints> WarpedPointsCache::Get(
    const std::vector<const ModelSample*>& samples) {
  for (const auto& [known, points] : entries_) {
    if (known == samples && points->AreOf(samples)) return points;
  }
  for (const ModelSample* sample : samples) CheckSample(sample, nodes_);
  entries_.emplace_back(samples, std::make_shared<WarpedPoints>(samples));
  return entries_.back().second;
}

}  // namespace splitfusion
