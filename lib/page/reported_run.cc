#include "splitfusion/lib/page/reported_run.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/report/json_lines.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> MontagesOf(const RunPaths& paths) {
  std::error_code missing;
  std::set<std::string> found;
  for (const auto& entry :
       std::filesystem::directory_iterator(paths.Pictures(), missing)) {
    if (entry.path().filename().string().find("_montage.png") !=
        std::string::npos) {
      found.insert(entry.path().string());
    }
  }
  return {found.begin(), found.end()};
}

/// Name of a run's folder; before it is in its place it is within that.
std::string NameOf(const RunPaths& paths) {
  const std::filesystem::path root(paths.root());
  const std::filesystem::path parent = root.parent_path();
  const bool unfinished = RunPaths(parent.string()).Unfinished() == root;
  return (unfinished ? parent : root).filename().string();
}

}  // namespace

ReportedRun ReportedRunOf(const RunPaths& paths, const Json& summary) {
  ReportedRun run;
  run.folder = paths.root();
  run.name = NameOf(paths);
  run.summary = summary;
  const Json marker = ReadJsonOrNull(paths.Marker());
  if (marker.is_object()) {
    run.options = marker.value("identity_parts", Json());
    run.defaults = marker.value("defaults", Json());
  }
  run.evaluation = ReadJsonOrNull(paths.Evaluation());
  run.curves =
      GatherCurves(ReadJsonLines(paths.Frames()), summary.at("surfaces"));
  run.pictures = MontagesOf(paths);
  return run;
}

ReportedRun ReadReportedRun(const RunPaths& paths) {
  const Json summary = ReadJsonOrNull(paths.Summary());
  if (!summary.is_object()) {
    throw InputError(paths.Summary() +
                     ": expected the summary of a run that has ended");
  }
  for (const char* key :
       {"surfaces", "seconds_per_frame", "peak_memory_bytes", "versions"}) {
    if (!summary.contains(key)) {
      throw InputError(paths.Summary() + ": has no '" + key +
                       "': expected the summary of a run of this version");
    }
  }
  try {
    return ReportedRunOf(paths, summary);
  } catch (const Json::exception& error) {
    throw InputError(
        paths.Frames() +
        ": not as a run of this version writes it: " + error.what());
  }
}

bool IsOfSolvers(const std::string& folder) {
  return std::filesystem::exists(std::filesystem::path(folder) / "solvers.csv");
}

ReportedSolvers ReadReportedSolvers(const std::string& folder) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".svg") files.insert(entry.path().string());
  }
  ReportedSolvers solvers{std::filesystem::path(folder).filename().string(),
                          {}};
  for (const std::string& file : files) {
    std::ifstream stream(file);
    std::string svg{std::istreambuf_iterator<char>(stream), {}};
    if (svg.rfind("<svg", 0) != 0) {
      throw InputError(file + ": expected a figure of sf_solve, <svg ...");
    }
    solvers.figures.push_back(std::move(svg));
  }
  return solvers;
}

}  // namespace splitfusion
