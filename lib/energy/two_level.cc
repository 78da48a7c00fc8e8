#include "splitfusion/lib/energy/two_level.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <utility>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

/// Nodes of a patch. With larger ones iterations get more (24: 24 instead of 18
/// in the mean of a sequence), with smaller ones the factorisation dearer.
constexpr int kPatchNodes = 12;  // Speed.

/// What the diagonal of P^T A P is raised by, relative to that of A: a part
/// that nothing holds has no stiffness there at all but for the damping.
constexpr double kRaise = 1e-9;  // Maths.

/// By node, those that it shares blocks with: of node i those from begin[i] to
/// begin[i + 1].
struct Neighbors {
  explicit Neighbors(const SymmetricBlockMatrix& matrix)
      : begin(matrix.size() + 2, 0) {
    const auto each_pair = [&](auto visit) {
      for (int i = 0; i < matrix.size(); ++i) {
        const int end = matrix.row_begin()[i + 1];
        for (int k = matrix.row_begin()[i] + 1; k < end; ++k) {
          visit(i, matrix.columns()[k]);
        }
      }
    };
    each_pair([&](int i, int j) {
      ++begin[i + 2];
      ++begin[j + 2];
    });
    for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
    nodes.resize(begin.back());
    each_pair([&](int i, int j) {
      nodes[begin[i + 1]++] = j;
      nodes[begin[j + 1]++] = i;
    });
  }

  std::vector<int> begin, nodes;
};

/// Lets a patch grow from `seed` over nodes that are free, -1 in `patch_of`,
/// and lists them. Returns another patch beside it; -1: there is none.
int Grow(const Neighbors& neighbors, int seed, int patch, std::size_t largest,
         std::vector<int>* patch_of, std::vector<int>* members) {
  int beside = -1;
  members->assign(1, seed);
  (*patch_of)[seed] = patch;
  for (std::size_t next = 0; next < members->size(); ++next) {
    const int from = (*members)[next];
    for (int k = neighbors.begin[from]; k < neighbors.begin[from + 1]; ++k) {
      const int node = neighbors.nodes[k];
      int& its_patch = (*patch_of)[node];
      if (its_patch >= 0 && its_patch != patch) beside = its_patch;
      if (its_patch >= 0 || members->size() == largest) continue;
      its_patch = patch;
      members->push_back(node);
    }
  }
  return beside;
}

/// P^T A P. Patches have a block where nodes of theirs have one.
SymmetricBlockMatrix CarriedByPatches(
    const SymmetricBlockMatrix& matrix, const NodePatches& patches,
    const std::vector<Eigen::Vector3d>& arms) {
  const std::vector<int>& patch = patches.of_node;
  const auto each_block = [&](auto visit) {
    for (int i = 0; i < matrix.size(); ++i) {
      for (int k = matrix.row_begin()[i]; k < matrix.row_begin()[i + 1]; ++k) {
        visit(k, std::minmax(patch[i], patch[matrix.columns()[k]]));
      }
    }
  };
  std::vector<std::pair<int, int>> pairs;
  each_block([&](int, const std::pair<int, int>& pair) {
    if (pairs.empty() || pairs.back() != pair) pairs.push_back(pair);
  });
  SymmetricBlockMatrix coarse(patches.size(), std::move(pairs));
  std::vector<int> targets(matrix.block_count());
  each_block([&](int k, const std::pair<int, int>& pair) {
    targets[k] = coarse.Index(pair.first, pair.second);
  });
  AddRigidlyCarried(matrix.size(), matrix.row_begin().data(),
                    matrix.columns().data(), matrix.blocks().data()->data(),
                    arms.data()->data(), patch.data(), targets.data(),
                    coarse.blocks().data()->data());
  for (int i = 0; i < matrix.size(); ++i) {
    coarse.Diagonal(patch[i]).diagonal() +=
        kRaise * matrix.Diagonal(i).diagonal();
  }
  return coarse;
}

/// Means of the nodes' centres.
std::vector<Eigen::Vector3d> CentersOf(
    const std::vector<int>& patch, int count,
    const std::vector<Eigen::Vector3d>& centers) {
  std::vector<Eigen::Vector3d> means(count, Eigen::Vector3d::Zero());
  std::vector<int> sizes(count, 0);
  for (std::size_t i = 0; i < patch.size(); ++i) {
    means[patch[i]] += centers[i];
    ++sizes[patch[i]];
  }
  for (int a = 0; a < count; ++a) means[a] /= sizes[a];
  return means;
}

/// c_i - c_a by node.
std::vector<Eigen::Vector3d> ArmsOf(
    const NodePatches& patches, const std::vector<Eigen::Vector3d>& centers) {
  std::vector<Eigen::Vector3d> arms = centers;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    arms[i] -= patches.centers[patches.of_node[i]];
  }
  return arms;
}

}  // namespace

NodePatches MakePatches(const SymmetricBlockMatrix& matrix,
                        const std::vector<Eigen::Vector3d>& centers,
                        int largest) {
  assert(static_cast<int>(centers.size()) == matrix.size() && largest > 0);
  const Neighbors neighbors(matrix);
  NodePatches patches;
  patches.of_node.assign(matrix.size(), -1);
  int count = 0;
  std::vector<int> members;
  for (int seed = 0; seed < matrix.size(); ++seed) {
    if (patches.of_node[seed] >= 0) continue;
    const int beside =
        Grow(neighbors, seed, count, largest, &patches.of_node, &members);
    if (beside < 0 || 3 * static_cast<int>(members.size()) >= largest) {
      ++count;
      continue;
    }
    for (const int node : members) patches.of_node[node] = beside;
  }
  patches.centers = CentersOf(patches.of_node, count, centers);
  return patches;
}

TwoLevel::TwoLevel(const SymmetricBlockMatrix& matrix,
                   const std::vector<Eigen::Vector3d>& centers)
    : inverse_(InverseDiagonal(matrix)),
      patches_(MakePatches(matrix, centers, kPatchNodes)),
      arms_(ArmsOf(patches_, centers)),
      coarse_(CarriedByPatches(matrix, patches_, arms_)),
      factor_(coarse_) {}

std::vector<Vector6> TwoLevel::Gathered(const std::vector<Vector6>& x) const {
  std::vector<Vector6> sums(patches_.size(), Vector6::Zero());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector3d force = x[i].tail<3>();
    Vector6& sum = sums[patches_.of_node[i]];
    sum.head<3>() += x[i].head<3>() + arms_[i].cross(force);
    sum.tail<3>() += force;
  }
  return sums;
}

void TwoLevel::AddCarried(const std::vector<Vector6>& x,
                          std::vector<Vector6>* out) const {
  for (std::size_t i = 0; i < out->size(); ++i) {
    const Vector6& motion = x[patches_.of_node[i]];
    const Eigen::Vector3d turn = motion.head<3>();
    (*out)[i] += motion;
    (*out)[i].tail<3>() += turn.cross(arms_[i]);
  }
}

double TwoLevel::Apply(const std::vector<Vector6>& in,
                       std::vector<Vector6>* out) const {
  MultiplyDiagonal(static_cast<int>(in.size()), inverse_.data()->data(),
                   in.data()->data(), out->data()->data());
  std::vector<Vector6> motions(patches_.size());
  factor_.Apply(Gathered(in), &motions);
  AddCarried(motions, out);
  return DotProduct(6 * static_cast<int>(in.size()), in.data()->data(),
                    out->data()->data());
}

}  // namespace splitfusion
