#ifndef SPLITFUSION_LIB_REPORT_HTML_REPORT_H_
#define SPLITFUSION_LIB_REPORT_HTML_REPORT_H_

#include <nlohmann/json_fwd.hpp>

#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// Writes RUN/report.html from frames.jsonl and the given summary (the value of
/// summary.json): tables, charts over frames (inline SVG; lost frames red) and
/// links to the pictures. One file that loads nothing else.
///
/// @throw InputError if frames.jsonl is broken or the file cannot be written.
void WriteHtmlReport(const RunPaths& paths,
                     const nlohmann::ordered_json& summary);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_HTML_REPORT_H_
