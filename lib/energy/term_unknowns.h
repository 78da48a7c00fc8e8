#ifndef SPLITFUSION_LIB_ENERGY_TERM_UNKNOWNS_H_
#define SPLITFUSION_LIB_ENERGY_TERM_UNKNOWNS_H_

#include <vector>

#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/energy/unknown.h"

namespace splitfusion {

/// What a term declares.
///
/// @throw InputError on unknowns without a name, of one name, with values that
///     are none, or too many of them.
std::vector<Unknown> DeclaredUnknowns(const WeightedTerm& term);

/// The own unknowns of all terms of a problem, one after the other in order of
/// the energy. Solvers seek each in units of its scale.
class TermUnknowns {
 public:
  /// @throw InputError as DeclaredUnknowns(), and if the problem has values for
  ///     others than its terms declare, or such that are not finite.
  explicit TermUnknowns(const SurfaceProblem& problem);

  /// Number of all unknowns.
  int size() const { return static_cast<int>(scales_.size()); }
  /// Place of a term's first unknown; of one past the last term: size().
  int first(std::size_t term) const { return first_[term]; }
  /// Number of a term's unknowns.
  int count(std::size_t term) const { return first_[term + 1] - first_[term]; }

  /// Scales of a term's unknowns.
  std::vector<double> ScalesOf(std::size_t term) const;

  /// What is sought, where the minimisation begins.
  std::vector<double> Start() const;
  /// Values where it begins.
  std::vector<double> StartValues() const;
  /// What became of them, as the `sought` of all say.
  std::vector<UnknownEstimate> Estimates(const double* sought) const;

 private:
  std::vector<UnknownEstimate> begin_;  // final: as initial.
  std::vector<double> scales_;
  std::vector<int> first_;  // By term.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_UNKNOWNS_H_
