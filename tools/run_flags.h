#ifndef SPLITFUSION_TOOLS_RUN_FLAGS_H_
#define SPLITFUSION_TOOLS_RUN_FLAGS_H_

#include <gflags/gflags.h>

#include <string>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// Reader options from the flags of sf_run.
ReaderOptions ReaderOptionsFromFlags();

/// Options of the method from the flags of sf_run, the preset applied first.
///
/// @throw InputError if a flag's value is out of its range or not registered.
PipelineOptions PipelineOptionsFromFlags(const Registries& registries);

/// Whether a flag is one of sf_run's own, gflags' and glog's left out.
bool IsRunFlag(const gflags::CommandLineFlagInfo& flag);

/// Every flag of sf_run with its value, as a flagfile that repeats the run from
/// any folder: paths of files that exist are absolute.
std::string FlagfileText();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_RUN_FLAGS_H_
