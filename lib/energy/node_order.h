#ifndef SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_
#define SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_

#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// The order in which a factorisation had best eliminate nodes, so that few
/// blocks fill in: for every node its new place. `coupled`: pairs of them with
/// a block that is not 0, in any order. `ordering`: SolverOptions::ordering.
///
/// @throw OptionError on another `ordering`.
std::vector<int> OrderNodes(int nodes,
                            const std::vector<std::pair<int, int>>& coupled,
                            const std::string& ordering);

/// The same for the blocks of a matrix.
std::vector<int> OrderNodes(const SymmetricBlockMatrix& matrix,
                            const std::string& ordering = "amd");

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_
