#ifndef SPLITFUSION_LIB_PAGE_HTML_REPORT_H_
#define SPLITFUSION_LIB_PAGE_HTML_REPORT_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/page/reported_run.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// What a page has of each run besides tables and charts.
struct ReportContent {
  bool viewer = true;    ///< Its surfaces in 3D.
  bool pictures = true;  ///< At most 24 montages.
};

/// One self-contained page that loads nothing: of several runs a table and
/// charts that compare them, of each its summary, evaluation, energy and
/// options (those first that differ from their defaults), its surfaces in 3D,
/// states and decisions, pictures, and of up to four runs its curves over the
/// frames (lost frames and costs that are not finite are marked red); at the
/// end the figures of `solvers`. Numbers are rounded for people. Where the
/// project was built without node, charts are drawings, and there is no viewer.
///
/// `left_out`: receives a line for each run whose surfaces cannot be shown, as
/// a file of them is missing or broken; the page says it as well.
std::string HtmlReport(const std::vector<ReportedRun>& runs,
                       const ReportContent& content = {},
                       const std::vector<ReportedSolvers>& solvers = {},
                       std::vector<std::string>* left_out = nullptr);

/// Writes RUN/report.html. `summary`: the value of summary.json.
///
/// @throw InputError if frames.jsonl is broken or the file cannot be written.
void WriteHtmlReport(const RunPaths& paths,
                     const nlohmann::ordered_json& summary);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_HTML_REPORT_H_
