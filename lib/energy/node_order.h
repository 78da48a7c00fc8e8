#ifndef SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_
#define SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_

#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"

namespace splitfusion {

/// The order in which a factorisation of the matrix had best take its nodes,
/// so that few blocks fill in: for every node its new place; approximate
/// minimum degree of the pattern.
std::vector<int> OrderNodes(const SymmetricBlockMatrix& matrix);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_NODE_ORDER_H_
