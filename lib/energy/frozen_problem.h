#ifndef SPLITFUSION_LIB_ENERGY_FROZEN_PROBLEM_H_
#define SPLITFUSION_LIB_ENERGY_FROZEN_PROBLEM_H_

#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/block_matrix.h"
#include "splitfusion/lib/energy/links_in_time.h"
#include "splitfusion/lib/energy/solver.h"

namespace splitfusion {

/// Cost and gradient of a problem where its solver starts.
struct ProblemStart {
  double cost = 0;                ///< Energy, Eq. 4.
  std::vector<double> terms;      ///< Of every term.
  std::vector<Vector6> gradient;  ///< By the twist of every node.
  /// By the terms' own unknowns, each in units of its scale.
  std::vector<double> by_unknowns;
};

/// Evaluates a problem at the graph's motions.
ProblemStart EvaluateStart(const SurfaceProblem& problem,
                           const DeformationGraph& graph);

/// One solve of a run, with all that it is made of: what a SurfaceProblem and
/// the graph were when the solver got them, and what the solver of the run made
/// of them.
struct FrozenProblem {
  int frame = 0;              ///< Index.
  int surface = 0;            ///< Id; 0 = background.
  Energy energy;              ///< With the terms themselves.
  PinholeCamera camera;       ///< As SurfaceProblem::camera.
  double anneal = 1;          ///< As SurfaceProblem::anneal.
  double initial_radius = 0;  ///< As SurfaceProblem::initial_radius.
  DeformationGraph graph;     ///< Motions: where the solver started.
  std::vector<Correspondence> correspondences;  ///< As in SurfaceProblem ...
  std::optional<std::vector<Correspondence>> lost;  ///< ... likewise ...
  std::optional<std::vector<TrackedPoint>> tracks;  ///< ... likewise ...
  std::optional<std::vector<NodeMotion>> before;    ///< ... likewise ...
  std::optional<LinksInTime> links;                 ///< ... likewise.
  std::vector<double> unknowns;  ///< Values at which all of them begin.
  ProblemStart start;            ///< As the run had it.
  std::string solver;            ///< The run's.
  double final_cost = 0;         ///< Where it ended.

  /// The problem itself; holds as long as this. Without a live frame.
  SurfaceProblem View() const;
};

/// Copies a problem with the graph; nothing is evaluated.
FrozenProblem CopyProblem(const SurfaceProblem& problem,
                          const DeformationGraph& graph);

/// Copies a problem and evaluates its start.
///
/// @throw InputError if a term has another cost without the live frame and
///     SurfaceProblem::context, which are not kept.
FrozenProblem Freeze(const SurfaceProblem& problem,
                     const DeformationGraph& graph);

/// Writes a problem as one HDF5 file, through a temporary name: all numbers as
/// the solver saw them. Layout: docs/solvers.md.
///
/// @throw InputError if it cannot be written.
void WriteFrozenProblem(const std::string& path, const FrozenProblem& problem);

/// Reads what WriteFrozenProblem() wrote. `terms`: those that its energy may
/// name.
///
/// @throw InputError that names the file if it is no such file, damaged, of a
///     later version, or of a term that is not known.
FrozenProblem ReadFrozenProblem(const std::string& path,
                                const TermRegistry& terms);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_FROZEN_PROBLEM_H_
