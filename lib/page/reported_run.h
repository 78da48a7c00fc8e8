#ifndef SPLITFUSION_LIB_PAGE_REPORTED_RUN_H_
#define SPLITFUSION_LIB_PAGE_REPORTED_RUN_H_

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/page/run_curves.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {

/// What is shown of a run.
struct ReportedRun {
  std::string folder;               ///< Where it is.
  std::string name;                 ///< Heading.
  nlohmann::ordered_json summary;   ///< summary.json
  nlohmann::ordered_json options;   ///< "identity_parts" of run.json, or null.
  nlohmann::ordered_json defaults;  ///< "defaults" of run.json, or null.
  nlohmann::ordered_json evaluation;  ///< evaluation.json, or null.
  RunCurves curves;                   ///< Over its frames.
  std::vector<std::string> pictures;  ///< Paths of montages, by frame.
};

/// Reads a run that has ended, complete or not.
///
/// @throw InputError if the folder holds none, or a file is broken.
ReportedRun ReadReportedRun(const RunPaths& paths);

/// The same, given the value of summary.json, which is not read.
ReportedRun ReportedRunOf(const RunPaths& paths,
                          const nlohmann::ordered_json& summary);

/// What is shown of solvers that were compared.
struct ReportedSolvers {
  std::string name;  ///< Heading.
  std::vector<std::string>
      figures;  ///< SVG: performance profiles and the like.
};

/// Whether a folder was written by sf_solve.
bool IsOfSolvers(const std::string& folder);

/// Reads one.
///
/// @throw InputError if a figure cannot be read.
ReportedSolvers ReadReportedSolvers(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_REPORTED_RUN_H_
