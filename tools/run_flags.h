#ifndef SPLITFUSION_TOOLS_RUN_FLAGS_H_
#define SPLITFUSION_TOOLS_RUN_FLAGS_H_

#include <gflags/gflags.h>

#include <string>

#include "splitfusion/lib/sequence/tum_reader.h"
#include "splitfusion/pipelines/pipeline_options.h"

namespace splitfusion {

/// Reader options from the flags of sf_run.
TumReaderOptions ReaderOptionsFromFlags();

/// Options of the method from the flags of sf_run, the preset applied first.
///
/// @throw InputError if a flag's value is out of its range.
PipelineOptions PipelineOptionsFromFlags();

/// Whether a flag is one of sf_run's own, gflags' and glog's left out.
bool IsRunFlag(const gflags::CommandLineFlagInfo& flag);

/// Every flag of sf_run with its value, as a flagfile that repeats the run.
std::string FlagfileText();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_RUN_FLAGS_H_
