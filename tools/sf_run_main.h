#ifndef SPLITFUSION_TOOLS_SF_RUN_MAIN_H_
#define SPLITFUSION_TOOLS_SF_RUN_MAIN_H_

#include "splitfusion/pipelines/registries.h"

namespace splitfusion {

/// The main() of sf_run, and of programs that are sf_run with energy terms,
/// associations, solvers or data sets of their own: all flags, pictures and
/// reports, and `sf_batch --set="run_program=..."` takes them. Call it once.
///
/// Returns the exit status: 0 if all went well, 2 for bad usage or input, 1 for
/// anything else.
int SfRunMain(int argc, char** argv, Registries registries);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_SF_RUN_MAIN_H_
