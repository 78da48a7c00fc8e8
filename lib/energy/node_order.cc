#include "splitfusion/lib/energy/node_order.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace splitfusion {

std::vector<int> OrderNodes(const SymmetricBlockMatrix& matrix) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < matrix.size(); ++row) {
    for (int k = matrix.row_begin()[row]; k < matrix.row_begin()[row + 1];
         ++k) {
      entries.emplace_back(row, matrix.columns()[k], 1);
    }
  }
  Eigen::SparseMatrix<double> pattern(matrix.size(), matrix.size());
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Upper>(), inverse);
  std::vector<int> places(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) places[inverse.indices()[i]] = i;
  return places;
}

}  // namespace splitfusion
