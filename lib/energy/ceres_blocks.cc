#include "splitfusion/lib/energy/ceres_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {
namespace {

/// Copies a row over all nodes' twists into Ceres' blocks, which may be null.
void SplitRow(const double* values, int nodes, int row, double** jacobians) {
  for (int k = 0; k < nodes; ++k, values += kTwistSize) {
    if (jacobians[k] == nullptr) continue;
    std::copy_n(values, kTwistSize, jacobians[k] + kTwistSize * row);
  }
}

/// Rows of a block with so many residuals of its own.
int WithRest(int rows, const ResidualScaling& scaling) {
  return scaling.loss == nullptr ? rows : rows + 1;
}

/// Copies columns of derivatives by unknowns into a Jacobian by rows, from
/// `first` on.
void FillRows(const double* columns, int rows, int unknowns, int first,
              double* jacobian) {
  for (int row = 0; row < rows; ++row) {
    for (int u = 0; u < unknowns; ++u) {
      jacobian[unknowns * (first + row) + u] = columns[rows * u + row];
    }
  }
}

/// A block of residuals over so many nodes, and unknowns of their term.
class BlockCost : public ceres::CostFunction {
 protected:
  /// `rows` residuals of its own.
  BlockCost(int rows, int nodes, int unknowns, const ResidualScaling& scaling)
      : rows_(rows) {
    mutable_parameter_block_sizes()->assign(nodes, kTwistSize);
    if (unknowns > 0) mutable_parameter_block_sizes()->push_back(unknowns);
    set_num_residuals(WithRest(rows, scaling));
  }

  /// Sets the residual that makes the squared norm twice the cost, if there is
  /// a loss, and its derivative.
  void SetRest(double cost, double* residuals, double** jacobians) const {
    if (num_residuals() == rows_) return;
    double squared = 0;
    for (int i = 0; i < rows_; ++i) squared += residuals[i] * residuals[i];
    residuals[rows_] = std::sqrt(std::max(2 * cost - squared, 0.0));
    if (jacobians == nullptr) return;
    for (std::size_t k = 0; k < parameter_block_sizes().size(); ++k) {
      if (jacobians[k] == nullptr) continue;
      const int size = parameter_block_sizes()[k];
      std::fill_n(jacobians[k] + size * rows_, size, 0.0);
    }
  }

 private:
  int rows_;
};

/// Residuals of one group of points.
class PointGroupCost : public BlockCost {
 public:
  PointGroupCost(const DeformationGraph& graph, const TermResiduals& residuals,
                 const WarpedPoints::Group& group)
      : BlockCost(residuals.of_points->dims() * (group.end - group.begin),
                  group.node_count, residuals.of_points->unknowns(),
                  residuals.of_points->scaling()),
        graph_(graph),
        points_(residuals.points),
        residuals_(residuals.of_points),
        group_(group) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    std::array<TwistedNode, kMaxSkinningNodes> twisted;
    std::array<const TwistedNode*, kMaxSkinningNodes> nodes;
    for (int k = 0; k < group_.node_count; ++k) {
      twisted[k] = TwistNode(graph_, group_.nodes[k], parameters[k]);
      nodes[k] = &twisted[k];
    }
    const int dims = residuals_->dims(), unknowns = residuals_->unknowns();
    const double* own = unknowns > 0 ? parameters[group_.node_count] : nullptr;
    const bool differentiate = jacobians != nullptr;
    double cost = 0;
    const int columns = kTwistSize * group_.node_count;
    std::array<double, 3 * kWarpedChunk> warped;
    std::array<double, CarriedSize(kMaxSkinningNodes)> carried;
    std::vector<double> by_point(differentiate ? 3 * kWarpedChunk * dims : 0);
    std::vector<double> by_unknowns(
        differentiate ? kWarpedChunk * dims * unknowns : 0);
    std::vector<double> rows(differentiate ? kWarpedChunk * dims * columns : 0);
    for (int begin = group_.begin; begin < group_.end; begin += kWarpedChunk) {
      const int end = std::min(begin + kWarpedChunk, group_.end);
      const int first = dims * (begin - group_.begin);
      const PointChunk chunk =
          WarpedPoints::Chunk(group_, begin, end, nodes.data());
      WarpChunk(chunk, warped.data(), carried.data());
      const PointValues values{residuals + first,
                               differentiate ? by_point.data() : nullptr,
                               by_unknowns.data()};
      if (!residuals_->Evaluate(begin, end - begin, warped.data(), own, values,
                                &cost)) {
        return false;
      }
      if (!differentiate) continue;
      DifferentiateChunk(chunk, carried.data(), dims, by_point.data(),
                         rows.data());
      for (int row = 0; row < dims * (end - begin); ++row) {
        SplitRow(&rows[row * columns], group_.node_count, first + row,
                 jacobians);
      }
      if (unknowns == 0 || jacobians[group_.node_count] == nullptr) continue;
      FillRows(by_unknowns.data(), dims * (end - begin), unknowns, first,
               jacobians[group_.node_count]);
    }
    SetRest(cost, residuals, jacobians);
    return true;
  }

 private:
  const DeformationGraph& graph_;
  std::shared_ptr<const WarpedPoints> points_;
  std::shared_ptr<const PointResiduals> residuals_;
  WarpedPoints::Group group_;
};

/// Residuals of one node tuple.
class NodeTupleCost : public BlockCost {
 public:
  NodeTupleCost(std::shared_ptr<const NodeResiduals> residuals, int tuple)
      : BlockCost(residuals->dims(),
                  static_cast<int>(residuals->nodes(tuple).size()),
                  /*unknowns=*/0, residuals->scaling()),
        residuals_(std::move(residuals)),
        tuple_(tuple) {}

  bool Evaluate(double const* const* twists, double* residuals,
                double** jacobians) const override {
    const int nodes = static_cast<int>(residuals_->nodes(tuple_).size());
    const int dims = residuals_->dims();
    std::vector<double> joint(jacobians == nullptr ? 0
                                                   : dims * nodes * kTwistSize);
    double cost = 0;
    if (!residuals_->Evaluate(tuple_, twists, residuals,
                              jacobians == nullptr ? nullptr : joint.data(),
                              &cost)) {
      return false;
    }
    SetRest(cost, residuals, jacobians);
    for (int row = 0; jacobians != nullptr && row < dims; ++row) {
      SplitRow(&joint[row * nodes * kTwistSize], nodes, row, jacobians);
    }
    return true;
  }

 private:
  std::shared_ptr<const NodeResiduals> residuals_;
  int tuple_;
};

/// Residuals of a term's own unknowns alone.
class UnknownsCost : public BlockCost {
 public:
  explicit UnknownsCost(std::shared_ptr<const UnknownResiduals> residuals)
      : BlockCost(residuals->rows(), /*nodes=*/0, residuals->unknowns(),
                  ResidualScaling()),
        residuals_(std::move(residuals)) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const int rows = residuals_->rows(), unknowns = residuals_->unknowns();
    std::vector<double> derivatives(rows * unknowns);
    double cost = 0;
    if (!residuals_->Evaluate(parameters[0], residuals, derivatives.data(),
                              &cost)) {
      return false;
    }
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    FillRows(derivatives.data(), rows, unknowns, 0, jacobians[0]);
    return true;
  }

 private:
  std::shared_ptr<const UnknownResiduals> residuals_;
};

}  // namespace

std::vector<ResidualBlock> MakeCeresBlocks(const DeformationGraph& graph,
                                           const TermResiduals& residuals) {
  std::vector<ResidualBlock> blocks;
  if (residuals.points != nullptr) {
    for (const WarpedPoints::Group& group : residuals.points->groups()) {
      blocks.push_back(
          {std::make_unique<PointGroupCost>(graph, residuals, group),
           std::vector<int>(group.nodes, group.nodes + group.node_count),
           residuals.of_points->unknowns() > 0});
    }
  }
  const auto& tuples = residuals.of_nodes;
  for (int i = 0; tuples != nullptr && i < tuples->size(); ++i) {
    blocks.push_back(
        {std::make_unique<NodeTupleCost>(tuples, i), tuples->nodes(i), false});
  }
  if (residuals.of_unknowns != nullptr) {
    blocks.push_back(
        {std::make_unique<UnknownsCost>(residuals.of_unknowns), {}, true});
  }
  return blocks;
}

}  // namespace splitfusion
