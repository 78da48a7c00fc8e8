#ifndef SPLITFUSION_PIPELINES_REGISTRIES_H_
#define SPLITFUSION_PIPELINES_REGISTRIES_H_

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/association/association.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// What the options of a run may name; register your own beside the built-in
/// ones.
struct Registries {
  TermRegistry terms = BuiltinTerms();                       ///< --terms
  AssociationRegistry associations = BuiltinAssociations();  ///< --association
  SolverRegistry solvers = BuiltinSolvers();                 ///< --solver
  FormatRegistry formats = BuiltinFormats();                 ///< --format
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_REGISTRIES_H_
