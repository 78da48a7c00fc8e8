#ifndef SPLITFUSION_LIB_ENERGY_TERM_OPTIONS_H_
#define SPLITFUSION_LIB_ENERGY_TERM_OPTIONS_H_

#include <string>

#include "splitfusion/lib/energy/robust_loss.h"

namespace splitfusion {

/// Weight and loss of one term, as the command line gives them.
struct TermOptions {
  /// Registered name of the term.
  std::string name;
  double weight = 1;  ///< Flag: of E_term; dimensionless.
  /// Robust loss of every residual vector.
  LossKind loss = LossKind::kTrivial;
  double scale = 0.01;  ///< Flag: inlier width of the loss, metres.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_TERM_OPTIONS_H_
