#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_blocks.h"

namespace splitfusion {

/// The energy of one surface as residual blocks over the twists of its nodes,
/// with their values and the normal equations. Sums do not depend on the number
/// of threads.
class BlockProblem {
 public:
  /// Gathers the blocks of all terms; `problem` and `graph` must outlive this.
  BlockProblem(const SurfaceProblem& problem, const DeformationGraph& graph);
  BlockProblem(const BlockProblem&) = delete;             ///< Not copied.
  BlockProblem& operator=(const BlockProblem&) = delete;  ///< Not copied.

  /// Evaluates all blocks at `twists` (kTwistSize a node); false if a value is
  /// not finite.
  bool Evaluate(const std::vector<double>& twists, bool with_jacobians);

  /// Cost as evaluated last.
  double Cost() const;
  /// The same by term, in the order of terms().
  std::vector<double> TermCosts() const;

  /// Matrix with a block wherever two nodes share a residual block.
  SymmetricBlockMatrix MakeMatrix() const;

  /// Sums J^T J and the gradient J^T r of all blocks as evaluated last with
  /// Jacobians; `matrix` is one of MakeMatrix().
  void Assemble(SymmetricBlockMatrix* matrix,
                std::vector<Vector6>* gradient) const;

  /// Terms of the energy.
  const std::vector<TermBlocks>& terms() const { return terms_; }
  /// Number of scalar residuals.
  int residual_count() const { return residual_count_; }

 private:
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

  /// One residual block with room for its values.
  struct EvaluatedBlock {
    const ResidualBlock* block;
    int term;
    double cost = 0;  // 1/2 rho(|r|^2)
    Eigen::VectorXd residuals;
    std::vector<Jacobian> jacobians;  // By node of the block.
  };

  static void EvaluateBlock(const std::vector<double>& twists,
                            bool with_jacobians, EvaluatedBlock* out);
  static void Accumulate(const EvaluatedBlock& block,
                         const SymmetricBlockMatrix& matrix,
                         std::vector<Block6>* blocks,
                         std::vector<Vector6>* gradient);

  std::vector<TermBlocks> terms_;
  int nodes_;
  int residual_count_ = 0;
  std::vector<EvaluatedBlock> blocks_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_
