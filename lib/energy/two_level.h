#ifndef SPLITFUSION_LIB_ENERGY_TWO_LEVEL_H_
#define SPLITFUSION_LIB_ENERGY_TWO_LEVEL_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/block_ic0.h"
#include "splitfusion/lib/energy/preconditioner.h"

namespace splitfusion {

/// Nodes in patches that are joined by blocks of a matrix.
struct NodePatches {
  std::vector<int> of_node;              ///< Number of the patch, from 0 on.
  std::vector<Eigen::Vector3d> centers;  ///< Mean of its nodes', metres.

  /// Number of patches.
  int size() const { return static_cast<int>(centers.size()); }
};

/// Divides all nodes into connected patches of at most `largest`; then what has
/// less than a third of that joins a patch beside it, if there is one. That one
/// may get larger, by any number of small ones.
NodePatches MakePatches(const SymmetricBlockMatrix& matrix,
                        const std::vector<Eigen::Vector3d>& centers,
                        int largest);

/// Block Jacobi for single nodes and, added to it, an incomplete factorisation
/// for rigid motions of patches of nodes:
///
///   M^-1 = D^-1 + P (P^T A P)^-1 P^T,   P^T A P by BlockIc0
///
/// where node i at c_i of patch a at c_a is carried by the patch's twist,
///
///   (P x)_i = (omega_a, tau_a + omega_a x (c_i - c_a)).
///
/// That is how parts move that hang on little: ARAP (Eq. 6) does not see it,
/// and block Jacobi alone hands it on from node to node, one an iteration.
class TwoLevel : public Preconditioner {
 public:
  /// `centers`: c_i = g_i + t_i of the nodes, metres.
  TwoLevel(const SymmetricBlockMatrix& matrix,
           const std::vector<Eigen::Vector3d>& centers);
  TwoLevel(const TwoLevel&) = delete;             ///< Not copied.
  TwoLevel& operator=(const TwoLevel&) = delete;  ///< Not copied.

  double Apply(const std::vector<Vector6>& in,
               std::vector<Vector6>* out) const override;

 private:
  /// P^T x
  std::vector<Vector6> Gathered(const std::vector<Vector6>& x) const;
  /// out += P x
  void AddCarried(const std::vector<Vector6>& x,
                  std::vector<Vector6>* out) const;

  Blocks6 inverse_;  // D^-1
  NodePatches patches_;
  std::vector<Eigen::Vector3d> arms_;  // c_i - c_a by node, metres.
  SymmetricBlockMatrix coarse_;        // P^T A P
  BlockIc0 factor_;                    // Of coarse_.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TWO_LEVEL_H_
