#ifndef SPLITFUSION_LIB_ENERGY_BORDERED_MATRIX_H_
#define SPLITFUSION_LIB_ENERGY_BORDERED_MATRIX_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// A vector over everything that a problem seeks.
struct BorderedVector {
  std::vector<Vector6> nodes;  ///< By node, of its twist.
  Eigen::VectorXd own;         ///< Of the terms' own unknowns; mostly none.
};

/// A symmetric positive semi-definite matrix over everything that a problem
/// seeks,
///
///   [ A    B ]
///   [ B^T  C ]
///
/// A over the twists, sparse; B and C over the terms' own unknowns, which are
/// few: dense.
struct BorderedMatrix {
  SymmetricBlockMatrix nodes;                ///< A
  std::vector<std::vector<Vector6>> border;  ///< B, by columns.
  Eigen::MatrixXd corner;                    ///< C
};

/// The entries of the diagonal.
BorderedVector DiagonalOf(const BorderedMatrix& matrix);

/// Whether all numbers are finite.
bool IsFinite(const BorderedVector& values);

/// y = M x.
void Multiply(const BorderedMatrix& matrix, const BorderedVector& x,
              BorderedVector* y);

/// a . b
double Dot(const std::vector<Vector6>& a, const std::vector<Vector6>& b);

/// What is left for the twists when the terms' own unknowns are eliminated from
/// M x = b, their Schur complement:
///
///   (A - W W^T) x_nodes = b_nodes - W L^-1 b_own,   W = B L^-T, C = L L^T
///
/// W W^T is never formed: it has as few columns as there are such unknowns.
class ReducedMatrix {
 public:
  /// Nothing to eliminate. The matrix must outlive this.
  explicit ReducedMatrix(const SymmetricBlockMatrix& nodes) : nodes_(nodes) {}
  /// The matrix must outlive this.
  explicit ReducedMatrix(const BorderedMatrix& matrix);

  /// Whether C is positive definite.
  bool usable() const { return corner_.info() == Eigen::Success; }
  /// Number of block rows.
  int size() const { return nodes_.size(); }
  /// Diagonal block of a row.
  Block6 Diagonal(int row) const;
  /// y = (A - W W^T) x.
  void Multiply(const std::vector<Vector6>& x, std::vector<Vector6>* y) const;

  /// The right side of the system above.
  std::vector<Vector6> RightSide(const BorderedVector& b) const;
  /// x_own of the solution that has these x_nodes.
  Eigen::VectorXd Own(const Eigen::VectorXd& b_own,
                      const std::vector<Vector6>& x_nodes) const;

 private:
  const SymmetricBlockMatrix& nodes_;
  Eigen::LLT<Eigen::MatrixXd> corner_{Eigen::MatrixXd(0, 0)};
  std::vector<std::vector<Vector6>> columns_;  // W
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BORDERED_MATRIX_H_
