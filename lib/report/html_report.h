#ifndef SPLITFUSION_LIB_REPORT_HTML_REPORT_H_
#define SPLITFUSION_LIB_REPORT_HTML_REPORT_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/report/run_curves.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// What is shown of a run.
struct ReportedRun {
  std::string name;                ///< Heading.
  nlohmann::ordered_json summary;  ///< summary.json
  nlohmann::ordered_json options;  ///< "identity_parts" of run.json, or null.
  nlohmann::ordered_json evaluation;  ///< evaluation.json, or null.
  RunCurves curves;                   ///< Over its frames.
  std::vector<std::string> pictures;  ///< Paths of montages, by frame.
};

/// Reads a run that has ended, complete or not.
///
/// @throw InputError if the folder holds none, or a file is broken.
ReportedRun ReadReportedRun(const RunPaths& paths);

/// One self-contained page that loads nothing: of several runs a table that
/// compares them, of each its summary, evaluation, energy and options, its
/// curves over the frames (inline SVG; lost frames and costs that are not
/// finite are marked red), states, and at most 24 pictures. Numbers are rounded
/// for people.
std::string HtmlReport(const std::vector<ReportedRun>& runs);

/// Writes RUN/report.html. `summary`: the value of summary.json.
///
/// @throw InputError if frames.jsonl is broken or the file cannot be written.
void WriteHtmlReport(const RunPaths& paths,
                     const nlohmann::ordered_json& summary);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_HTML_REPORT_H_
