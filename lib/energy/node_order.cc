#include "splitfusion/lib/energy/node_order.h"

#include <cholmod.h>

#include <Eigen/CholmodSupport>
#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <numeric>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Pattern = Eigen::SparseMatrix<double>;

/// The upper triangle.
Pattern PatternOf(int nodes, const std::vector<std::pair<int, int>>& coupled) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < nodes; ++i) entries.emplace_back(i, i, 1);
  for (const auto& [a, b] : coupled) {
    entries.emplace_back(std::min(a, b), std::max(a, b), 1);
  }
  Pattern pattern(nodes, nodes);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

/// The node of every place.
std::vector<int> MinimumDegree(const Pattern& pattern) {
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(pattern.selfadjointView<Eigen::Upper>(), order);
  return {order.indices().begin(), order.indices().end()};
}

std::vector<int> NestedDissection(const Pattern& pattern) {
  std::vector<int> order(pattern.cols()), parents(order), parts(order);
  const auto upper = pattern.selfadjointView<Eigen::Upper>();
  cholmod_sparse view = Eigen::viewAsCholmod(upper);
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  const bool ordered =
      order.empty() ||
      cholmod_nested_dissection(&view, nullptr, 0, order.data(), parents.data(),
                                parts.data(), &common) >= 0;
  cholmod_finish(&common);
  return ordered ? order : MinimumDegree(pattern);
}

std::vector<int> AsTheyAre(int nodes) {
  std::vector<int> order(nodes);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

}  // namespace

std::vector<int> OrderNodes(int nodes,
                            const std::vector<std::pair<int, int>>& coupled,
                            const std::string& ordering) {
  CheckOption(
      ordering == "amd" || ordering == "nesdis" || ordering == "natural",
      "ordering", ordering, "amd, nesdis or natural");
  const std::vector<int> order =
      ordering == "natural"  ? AsTheyAre(nodes)
      : ordering == "nesdis" ? NestedDissection(PatternOf(nodes, coupled))
                             : MinimumDegree(PatternOf(nodes, coupled));
  std::vector<int> places(nodes);
  for (int i = 0; i < nodes; ++i) places[order[i]] = i;
  return places;
}

std::vector<int> OrderNodes(const SymmetricBlockMatrix& matrix,
                            const std::string& ordering) {
  std::vector<std::pair<int, int>> coupled;
  for (int row = 0; row < matrix.size(); ++row) {
    for (int k = matrix.row_begin()[row]; k < matrix.row_begin()[row + 1];
         ++k) {
      coupled.emplace_back(row, matrix.columns()[k]);
    }
  }
  return OrderNodes(matrix.size(), coupled, ordering);
}

}  // namespace splitfusion
