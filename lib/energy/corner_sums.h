#ifndef SPLITFUSION_LIB_ENERGY_CORNER_SUMS_H_
#define SPLITFUSION_LIB_ENERGY_CORNER_SUMS_H_

#include <Eigen/Core>
#include <vector>

namespace splitfusion {

/// What the residuals of one term add to C and to the gradient by the term's
/// own unknowns: U^T U and U^T r, U the derivatives by these. Kept by block, so
/// that blocks can be evaluated in parallel and the sums have one order.
class CornerSums {
 public:
  /// `unknowns`: of the term; without any this does nothing.
  CornerSums(int unknowns, int blocks)
      : unknowns_(unknowns), sums_(Stride() * blocks) {}

  /// Forgets what a block has added.
  void Clear(int block);

  /// Adds `rows` residuals of a block; `derivatives`: U by columns.
  void Add(int block, int rows, const double* residuals,
           const double* derivatives);

  /// Adds the sums over all blocks; `first`: place of the term's first unknown.
  void AddTo(int first, Eigen::MatrixXd* corner,
             Eigen::VectorXd* gradient) const;

 private:
  /// Numbers of a block: U^T r, then U^T U, the lower triangle of it.
  int Stride() const { return unknowns_ * (unknowns_ + 1); }

  int unknowns_;
  std::vector<double> sums_;  // By block.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_CORNER_SUMS_H_
