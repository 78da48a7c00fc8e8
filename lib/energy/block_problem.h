#ifndef SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_
#define SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/block_pattern.h"
#include "splitfusion/lib/energy/bordered_matrix.h"
#include "splitfusion/lib/energy/corner_sums.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/term_residuals.h"
#include "splitfusion/lib/energy/term_unknowns.h"
#include "splitfusion/lib/energy/warp_kernels.h"

namespace splitfusion {

/// The energy of one surface over the twists of its nodes and the terms' own
/// unknowns, with its values and normal equations. Sums do not depend on the
/// number of threads: every sum is taken by one thread in the order of the
/// blocks.
///
/// A block is what shares its nodes: a group of warped points, with the
/// residuals of all terms over these points, or one node tuple of one term.
class BlockProblem {
 public:
  /// Gathers the residuals of all terms; `problem` and `graph` must outlive
  /// this.
  ///
  /// @throw InputError, std::runtime_error as CollectResiduals().
  BlockProblem(const SurfaceProblem& problem, const DeformationGraph& graph);
  BlockProblem(const BlockProblem&) = delete;             ///< Not copied.
  BlockProblem& operator=(const BlockProblem&) = delete;  ///< Not copied.

  /// Where a minimisation begins: no twists, kTwistSize numbers a node, then
  /// what is sought of the terms' own unknowns (TermUnknowns::Start()).
  std::vector<double> Start() const;

  /// Evaluates all blocks at `sought`, which is as Start(); false if a value is
  /// not finite.
  ///
  /// @throw InputError or std::runtime_error if a functor throws; names the
  ///     term.
  bool Evaluate(const std::vector<double>& sought, bool with_jacobians);

  /// Cost as evaluated last.
  double Cost() const;
  /// The same by term, in the order of terms().
  std::vector<double> TermCosts() const;

  /// Matrix with a block wherever two nodes share a residual block.
  BorderedMatrix MakeMatrix() const;

  /// Sums J^T J and the gradient J^T r of all blocks as evaluated last with
  /// Jacobians; `matrix` is one of MakeMatrix().
  void Assemble(BorderedMatrix* matrix, BorderedVector* gradient) const;

  /// A sentence on the first term whose cost or derivatives are not finite at
  /// `sought`, which is as Start(); on all terms together if that is none.
  std::string NotFiniteAt(const std::vector<double>& sought) const;

  /// Terms of the energy.
  const std::vector<ProblemTerm>& terms() const { return terms_; }
  /// Their own unknowns.
  const TermUnknowns& unknowns() const { return unknowns_; }

 private:
  BlockProblem(const TermUnknowns& unknowns, const SurfaceProblem& problem,
               const DeformationGraph& graph);
  /// Of residuals that are collected.
  BlockProblem(const TermUnknowns& unknowns, std::vector<ProblemTerm> terms,
               const DeformationGraph& graph);

  /// Residuals of one term over common points.
  struct PointPart {
    int term;
    const PointResiduals* residuals;
    int first_unknown;  // Among those of the set.
  };
  /// Terms that share their points.
  struct PointSet {
    const WarpedPoints* points;
    std::vector<PointPart> parts;
    int dims = 0;               // Residuals of a point, all parts.
    std::vector<int> unknowns;  // Of all parts: columns of B.
    int first_block = 0;
  };
  /// Tuples of one term.
  struct TupleSet {
    int term;
    const NodeResiduals* residuals;
    int first_block = 0;
    int first_cost = 0;
  };
  struct GroupRoom;
  struct TupleRoom;

  bool HasFiniteDerivatives() const;
  void AddPoints(int term, const TermResiduals& residuals);
  void MakeBlocks();
  void EvaluatePoints(const PointSet& set, bool with_jacobians);
  void EvaluateGroup(const PointSet& set, int index, bool with_jacobians,
                     GroupRoom* room);
  /// Points begin..end of a group. `rows`: room for their Jacobian, or null.
  void EvaluateChunk(const PointSet& set, int index, int begin, int end,
                     double* rows, double* gradient, GroupRoom* room);
  /// The values of a part in the room; `index`: of the group.
  void EvaluatePart(const PointPart& part, int index, int begin, int end,
                    const PointValues& values, GroupRoom* room);
  /// The residuals of a term's own unknowns alone.
  void EvaluateUnknowns(std::size_t term);
  void EvaluateTuples(const TupleSet& set, const std::vector<double>& twists,
                      bool with_jacobians);
  void EvaluateTuple(const TupleSet& set, int tuple,
                     const std::vector<double>& twists, bool with_jacobians,
                     TupleRoom* room);

  const DeformationGraph& graph_;
  const TermUnknowns unknowns_;
  std::vector<ProblemTerm> terms_;
  std::vector<PointSet> point_sets_;
  std::vector<TupleSet> tuple_sets_;
  BlockPattern pattern_;
  std::vector<TwistedNode> twisted_;
  std::vector<double> own_;                 // Own unknowns, as sought.
  std::vector<std::vector<double>> costs_;  // By term and block of the term.
  std::vector<CornerSums> corners_;         // By term.
  std::unique_ptr<double[]> values_;        // See BlockPattern::Block.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_BLOCK_PROBLEM_H_
