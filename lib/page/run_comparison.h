#ifndef SPLITFUSION_LIB_PAGE_RUN_COMPARISON_H_
#define SPLITFUSION_LIB_PAGE_RUN_COMPARISON_H_

#include <nlohmann/json.hpp>
#include <vector>

#include "splitfusion/lib/page/html_page.h"
#include "splitfusion/lib/page/reported_run.h"

namespace splitfusion {

/// The facts of a whole run; lists and objects are left to other tables.
nlohmann::ordered_json FactsOf(const ReportedRun& run);

/// The headline of its evaluation; empty if there is none.
nlohmann::ordered_json HeadlineOf(const ReportedRun& run);

/// Adds what several runs are beside one another: a table of facts and figures,
/// and charts over the frames with a line a run, of each surface that has the
/// same name in two or more.
void AddComparison(const std::vector<ReportedRun>& runs, HtmlPage* page);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_RUN_COMPARISON_H_
