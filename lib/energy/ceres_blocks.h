#ifndef SPLITFUSION_LIB_ENERGY_CERES_BLOCKS_H_
#define SPLITFUSION_LIB_ENERGY_CERES_BLOCKS_H_

#include <ceres/cost_function.h>

#include <memory>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/residual_sink.h"

namespace splitfusion {

/// One residual block for Ceres. Ceres' loss is the trivial one: the block has
/// applied its own.
struct ResidualBlock {
  /// Residuals and Jacobians over the nodes' twists.
  std::unique_ptr<ceres::CostFunction> cost;
  /// Nodes of the parameter blocks, in order.
  std::vector<int> nodes;
  /// Whether one more parameter block follows: the term's own unknowns, in
  /// units of their scales.
  bool has_unknowns = false;
};

/// The residuals of a term as Ceres' cost functions: a block for every group of
/// points with common nodes, one for every node tuple and one for what depends
/// on the term's own unknowns alone. They keep what they need of `residuals`;
/// `graph` must outlive them and not change.
///
/// Ceres applies a loss to a whole block, so the losses are applied within, as
/// ResidualScaling says. With a loss, one more residual a block, sqrt(sum of
/// rho(s) - rho'(s) s) >= 0, has a zero Jacobian and makes the squared norm of
/// the block the sum of rho(s): cost, gradient and Gauss-Newton matrix all
/// equal those of one Ceres block a residual vector with Ceres' own loss.
std::vector<ResidualBlock> MakeCeresBlocks(const DeformationGraph& graph,
                                           const TermResiduals& residuals);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_CERES_BLOCKS_H_
