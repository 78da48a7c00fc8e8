#ifndef SPLITFUSION_TOOLS_METHOD_FLAGS_H_
#define SPLITFUSION_TOOLS_METHOD_FLAGS_H_

#include <string>

#include "splitfusion/lib/sequence/depth_filter.h"
#include "splitfusion/pipelines/pipeline_options.h"
#include "splitfusion/pipelines/registries.h"

namespace splitfusion {

/// Makes a flag of every option of the method (PipelineOptions::List) and of
/// the depth that it is given (DepthOptions::List). Those that --help shows
/// belong to the file "method_flags", the others to "method_details". To be
/// called before the command line is read, once.
void RegisterMethodFlags();

/// The options as their flags state them; what is changed here is as if it had
/// been given.
PipelineOptions& MethodFlags();

/// Sets what flags state of the depth sensor; the rest stays as it is, as a
/// sensor's name left it, and its flags follow.
void TakeDepthFlags(DepthOptions* depth);

/// Sets the options whose flags were given; the others stay as they are, as a
/// preset left them, and their flags follow.
void TakeMethodFlags(PipelineOptions* options);

/// All options of the method, with the names registered, as a table in
/// Markdown: docs/options.md.
std::string MethodOptionsMarkdown(const Registries& registries);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_METHOD_FLAGS_H_
