#include "splitfusion/lib/energy/block_problem.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "splitfusion/lib/energy/block_kernels.h"
#include "splitfusion/lib/energy/term_call.h"
#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {
namespace {

/// Blocks of a task.
constexpr int kGrain = 64;  // Speed.

/// The places of a group's nodes in its own sums.
constexpr std::array<int, kMaxSkinningNodes> kInOrder = {0, 1, 2, 3,  // Layout.
                                                         4, 5, 6, 7};

}  // namespace

/// What the evaluation of a group needs besides its values.
struct BlockProblem::GroupRoom {
  GroupRoom(int dims, int unknowns)
      : residuals(kWarpedChunk * dims),
        by_point(3 * kWarpedChunk * dims),
        by_unknowns(kWarpedChunk * dims * unknowns),
        rows(new double[kWarpedChunk * dims * kTwistSize * kMaxSkinningNodes]) {
  }
  std::array<const TwistedNode*, kMaxSkinningNodes> nodes;
  std::array<double, 3 * kWarpedChunk> warped;
  std::array<double, CarriedSize(kMaxSkinningNodes)> carried;
  std::vector<double> residuals;
  std::vector<double> by_point;
  std::vector<double> by_unknowns;  // Of a part.
  std::unique_ptr<double[]> rows;   // Of a group that is summed.
};

/// The same for a tuple.
struct BlockProblem::TupleRoom {
  std::vector<const double*> twists;
  std::vector<double> residuals;
  std::vector<double> jacobian;
};

BlockProblem::BlockProblem(const SurfaceProblem& problem,
                           const DeformationGraph& graph)
    : BlockProblem(TermUnknowns(problem), problem, graph) {}

BlockProblem::BlockProblem(const TermUnknowns& unknowns,
                           const SurfaceProblem& problem,
                           const DeformationGraph& graph)
    : BlockProblem(unknowns, CollectResiduals(problem, unknowns, graph),
                   graph) {}

BlockProblem::BlockProblem(const TermUnknowns& unknowns,
                           std::vector<ProblemTerm> terms,
                           const DeformationGraph& graph)
    : graph_(graph),
      unknowns_(unknowns),
      terms_(std::move(terms)),
      twisted_(graph.size()) {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const TermResiduals& residuals = terms_[t].residuals;
    const int term = static_cast<int>(t);
    if (residuals.points != nullptr) AddPoints(term, residuals);
    if (residuals.of_nodes != nullptr) {
      tuple_sets_.push_back({term, residuals.of_nodes.get(), 0, 0});
    }
  }
  MakeBlocks();
}

void BlockProblem::AddPoints(int term, const TermResiduals& residuals) {
  auto set = std::find_if(
      point_sets_.begin(), point_sets_.end(),
      [&](const PointSet& s) { return s.points == residuals.points.get(); });
  if (set == point_sets_.end()) {
    set = point_sets_.insert(set, {residuals.points.get(), {}, 0, {}, 0});
  }
  set->parts.push_back({term, residuals.of_points.get(),
                        static_cast<int>(set->unknowns.size())});
  set->dims += residuals.of_points->dims();
  for (int u = 0; u < residuals.of_points->unknowns(); ++u) {
    set->unknowns.push_back(unknowns_.first(term) + u);
  }
}

void BlockProblem::MakeBlocks() {
  costs_.resize(terms_.size());
  for (PointSet& set : point_sets_) {
    set.first_block = static_cast<int>(pattern_.blocks().size());
    for (const WarpedPoints::Group& group : set.points->groups()) {
      pattern_.Add(group.nodes, group.node_count,
                   set.dims * (group.end - group.begin), set.unknowns,
                   /*may_sum=*/true);
    }
    for (const PointPart& part : set.parts) {
      costs_[part.term].assign(set.points->groups().size(), 0.0);
    }
  }
  std::vector<int> nodes;
  for (TupleSet& set : tuple_sets_) {
    set.first_block = static_cast<int>(pattern_.blocks().size());
    for (int i = 0; i < set.residuals->size(); ++i) {
      nodes = set.residuals->nodes(i);
      std::sort(nodes.begin(), nodes.end());
      pattern_.Add(nodes.data(), static_cast<int>(nodes.size()),
                   set.residuals->dims(), /*unknowns=*/{}, /*may_sum=*/false);
    }
    std::vector<double>& costs = costs_[set.term];
    set.first_cost = static_cast<int>(costs.size());
    costs.resize(costs.size() + set.residuals->size());
  }
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    if (terms_[t].residuals.of_unknowns != nullptr) costs_[t].push_back(0);
    corners_.emplace_back(unknowns_.count(t),
                          static_cast<int>(costs_[t].size()));
  }
  pattern_.Finish(graph_.size());
  values_.reset(new double[pattern_.value_count()]);
}

std::vector<double> BlockProblem::Start() const {
  std::vector<double> sought(kTwistSize * graph_.size(), 0.0);
  const std::vector<double> own = unknowns_.Start();
  sought.insert(sought.end(), own.begin(), own.end());
  return sought;
}

BorderedMatrix BlockProblem::MakeMatrix() const {
  const int own = unknowns_.size();
  return {pattern_.MakeMatrix(), std::vector<std::vector<Vector6>>(own),
          Eigen::MatrixXd::Zero(own, own)};
}

bool BlockProblem::Evaluate(const std::vector<double>& sought,
                            bool with_jacobians) {
  for (int i = 0; i < graph_.size(); ++i) {
    twisted_[i] = TwistNode(graph_, i, &sought[kTwistSize * i]);
  }
  own_.assign(sought.begin() + kTwistSize * graph_.size(), sought.end());
  for (const PointSet& set : point_sets_) EvaluatePoints(set, with_jacobians);
  for (const TupleSet& set : tuple_sets_) {
    EvaluateTuples(set, sought, with_jacobians);
  }
  for (std::size_t t = 0; t < terms_.size(); ++t) EvaluateUnknowns(t);
  return std::isfinite(Cost());
}

std::string BlockProblem::NotFiniteAt(const std::vector<double>& sought) const {
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    std::vector<ProblemTerm> alone(terms_.size());
    alone[t] = terms_[t];
    BlockProblem problem(unknowns_, alone, graph_);
    if (!problem.Evaluate(sought, /*with_jacobians=*/true)) {
      return NotFiniteText(alone, problem.TermCosts());
    }
    if (problem.HasFiniteDerivatives()) continue;
    return "The derivatives of term '" + terms_[t].cost.term +
           "' are not finite.";
  }
  return "The derivatives of all terms are not finite.";
}

bool BlockProblem::HasFiniteDerivatives() const {
  BorderedMatrix matrix = MakeMatrix();
  BorderedVector gradient;
  Assemble(&matrix, &gradient);
  return IsFinite(gradient) && IsFinite(DiagonalOf(matrix));
}

double BlockProblem::Cost() const {
  const std::vector<double> costs = TermCosts();
  return std::accumulate(costs.begin(), costs.end(), 0.0);
}

std::vector<double> BlockProblem::TermCosts() const {
  std::vector<double> costs;
  for (const std::vector<double>& blocks : costs_) {
    costs.push_back(std::accumulate(blocks.begin(), blocks.end(), 0.0));
  }
  return costs;
}

void BlockProblem::Assemble(BorderedMatrix* matrix,
                            BorderedVector* gradient) const {
  pattern_.Assemble(values_.get(), &matrix->nodes, &gradient->nodes,
                    &matrix->border);
  matrix->corner.setZero();
  gradient->own.setZero(unknowns_.size());
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    corners_[t].AddTo(unknowns_.first(t), &matrix->corner, &gradient->own);
  }
}

void BlockProblem::EvaluatePoints(const PointSet& set, bool with_jacobians) {
  const int groups = static_cast<int>(set.points->groups().size());
  tbb::parallel_for(tbb::blocked_range<int>(0, groups, kGrain / 4),
                    [&](const tbb::blocked_range<int>& range) {
                      GroupRoom room(set.dims, unknowns_.size());
                      for (int g = range.begin(); g < range.end(); ++g) {
                        EvaluateGroup(set, g, with_jacobians, &room);
                      }
                    });
}

void BlockProblem::EvaluateGroup(const PointSet& set, int index,
                                 bool with_jacobians, GroupRoom* room) {
  const WarpedPoints::Group& group = set.points->groups()[index];
  const BlockPattern::Block& block = pattern_.blocks()[set.first_block + index];
  double* gradient = &values_[block.offset];
  double* matrix = &values_[block.matrix_offset()];
  for (const PointPart& part : set.parts) costs_[part.term][index] = 0;
  for (int k = 0; k < group.node_count; ++k) {
    room->nodes[k] = &twisted_[group.nodes[k]];
  }
  if (with_jacobians) {
    std::fill(gradient, matrix, 0.0);
    if (block.summed) std::fill_n(matrix, block.matrix_size(), 0.0);
    for (const PointPart& part : set.parts) corners_[part.term].Clear(index);
  }
  for (int begin = group.begin; begin < group.end; begin += kWarpedChunk) {
    const int end = std::min(begin + kWarpedChunk, group.end);
    const int row = set.dims * (begin - group.begin);
    double* rows = block.summed ? room->rows.get()
                                : matrix + kTwistSize * group.node_count * row;
    EvaluateChunk(set, index, begin, end, with_jacobians ? rows : nullptr,
                  gradient, room);
    if (!with_jacobians || !block.summed) continue;
    double* sums = matrix;
    for (int k = 0; k < group.node_count; ++k) {
      AddOuterProducts(rows, set.dims * (end - begin), group.node_count, k,
                       kInOrder.data(), sums);
      sums += 36 * (group.node_count - k);
    }
  }
}

void BlockProblem::EvaluateChunk(const PointSet& set, int index, int begin,
                                 int end, double* rows, double* gradient,
                                 GroupRoom* room) {
  const WarpedPoints::Group& group = set.points->groups()[index];
  const PointChunk chunk =
      WarpedPoints::Chunk(group, begin, end, room->nodes.data());
  WarpChunk(chunk, room->warped.data(), room->carried.data());
  const PointValues values{room->residuals.data(),
                           rows == nullptr ? nullptr : room->by_point.data(),
                           room->by_unknowns.data()};
  for (const PointPart& part : set.parts) {
    EvaluatePart(part, index, begin, end, values, room);
    if (rows == nullptr) continue;
    const int dims = part.residuals->dims();
    const int count = dims * (end - begin);
    const int columns = kTwistSize * group.node_count;
    DifferentiateChunk(chunk, room->carried.data(), dims, room->by_point.data(),
                       rows);
    AddGradients(1, values.residuals, rows, count, columns, gradient);
    AddGradients(part.residuals->unknowns(), values.by_unknowns, rows, count,
                 columns, gradient + columns * (1 + part.first_unknown));
    rows += count * columns;
  }
}

void BlockProblem::EvaluatePart(const PointPart& part, int index, int begin,
                                int end, const PointValues& values,
                                GroupRoom* room) {
  const PointResiduals& residuals = *part.residuals;
  const int count = end - begin;
  double* cost = &costs_[part.term][index];
  const bool defined = CallTerm(terms_[part.term].cost.term, "evaluating", [&] {
    return residuals.Evaluate(begin, count, room->warped.data(),
                              own_.data() + unknowns_.first(part.term), values,
                              cost);
  });
  if (!defined) *cost = std::nan("");
  if (values.by_point == nullptr || residuals.unknowns() == 0) return;
  corners_[part.term].Add(index, count * residuals.dims(), values.residuals,
                          values.by_unknowns);
}

void BlockProblem::EvaluateUnknowns(std::size_t term) {
  const auto& of_unknowns = terms_[term].residuals.of_unknowns;
  if (of_unknowns == nullptr) return;
  std::vector<double> residuals(of_unknowns->rows());
  std::vector<double> derivatives(of_unknowns->rows() *
                                  of_unknowns->unknowns());
  double* cost = &costs_[term].back();
  *cost = 0;
  const bool defined = CallTerm(terms_[term].cost.term, "evaluating", [&] {
    return of_unknowns->Evaluate(own_.data() + unknowns_.first(term),
                                 residuals.data(), derivatives.data(), cost);
  });
  if (!defined) *cost = std::nan("");
  const int block = static_cast<int>(costs_[term].size()) - 1;
  corners_[term].Clear(block);
  corners_[term].Add(block, of_unknowns->rows(), residuals.data(),
                     derivatives.data());
}

void BlockProblem::EvaluateTuples(const TupleSet& set,
                                  const std::vector<double>& twists,
                                  bool with_jacobians) {
  tbb::parallel_for(tbb::blocked_range<int>(0, set.residuals->size(), kGrain),
                    [&](const tbb::blocked_range<int>& range) {
                      TupleRoom room;
                      CallTerm(terms_[set.term].cost.term, "evaluating", [&] {
                        for (int i = range.begin(); i < range.end(); ++i) {
                          EvaluateTuple(set, i, twists, with_jacobians, &room);
                        }
                      });
                    });
}

void BlockProblem::EvaluateTuple(const TupleSet& set, int tuple,
                                 const std::vector<double>& twists,
                                 bool with_jacobians, TupleRoom* room) {
  const std::vector<int>& nodes = set.residuals->nodes(tuple);
  const BlockPattern::Block& block = pattern_.blocks()[set.first_block + tuple];
  const int columns = kTwistSize * block.count;
  room->twists.clear();
  for (const int node : nodes)
    room->twists.push_back(&twists[kTwistSize * node]);
  room->residuals.resize(block.rows);
  room->jacobian.resize(block.rows * columns);
  double* cost = &costs_[set.term][set.first_cost + tuple];
  if (!set.residuals->Evaluate(
          tuple, room->twists.data(), room->residuals.data(),
          with_jacobians ? room->jacobian.data() : nullptr, cost)) {
    *cost = std::nan("");
  }
  if (!with_jacobians) return;
  // From the functor's order to ascending nodes.
  double* rows = &values_[block.matrix_offset()];
  const int* sorted = pattern_.nodes(block);
  for (int k = 0; k < block.count; ++k) {
    const int rank = static_cast<int>(
        std::lower_bound(sorted, sorted + block.count, nodes[k]) - sorted);
    for (int r = 0; r < block.rows; ++r) {
      std::copy_n(&room->jacobian[r * columns + kTwistSize * k], kTwistSize,
                  rows + r * columns + kTwistSize * rank);
    }
  }
  double* gradient = &values_[block.offset];
  std::fill_n(gradient, columns, 0.0);
  AddGradients(1, room->residuals.data(), rows, block.rows, columns, gradient);
}

}  // namespace splitfusion
