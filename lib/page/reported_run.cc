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

/// @throw InputError if it is not as a run of this version writes it.
void CheckSummary(const RunPaths& paths, const Json& summary) {
  const auto require = [&](bool right, const std::string& key) {
    if (right) return;
    throw InputError(paths.Summary() + ": '" + key +
                     "' is missing or of another type: expected the summary "
                     "of a run of this version");
  };
  for (const char* key : {"seconds_per_frame", "versions"}) {
    require(summary.contains(key) && summary[key].is_object(), key);
  }
  for (const char* key : {"median", "mean"}) {
    require(summary["seconds_per_frame"].contains(key), "seconds_per_frame");
  }
  require(summary.contains("peak_memory_bytes") &&
              summary["peak_memory_bytes"].is_number(),
          "peak_memory_bytes");
  require(summary.contains("surfaces") && summary["surfaces"].is_array(),
          "surfaces");
  for (const Json& surface : summary["surfaces"]) {
    require(surface.is_object() && surface.contains("label") &&
                surface["label"].is_string() && surface.contains("id") &&
                surface["id"].is_number_integer() &&
                surface.contains("nodes") && surface["nodes"].is_number(),
            "surfaces");
  }
}

/// An object of run.json; null if it is none.
Json ObjectOf(const Json& marker, const char* key) {
  const Json value = marker.value(key, Json());
  return value.is_object() ? value : Json();
}

}  // namespace

ReportedRun ReportedRunOf(const RunPaths& paths, const Json& summary) {
  ReportedRun run;
  run.folder = paths.root();
  run.name = NameOf(paths);
  run.summary = summary;
  const Json marker = ReadVersionedOrNull(paths.Marker());
  if (marker.is_object()) {
    run.options = ObjectOf(marker, "identity_parts");
    run.defaults = ObjectOf(marker, "defaults");
  }
  run.evaluation = ReadVersionedOrNull(paths.Evaluation());
  run.curves =
      GatherCurves(ReadJsonLines(paths.Frames()), summary.at("surfaces"));
  run.pictures = MontagesOf(paths);
  return run;
}

ReportedRun ReadReportedRun(const RunPaths& paths) {
  const Json summary = ReadVersionedOrNull(paths.Summary());
  if (!summary.is_object()) {
    throw InputError(paths.Summary() +
                     ": expected the summary of a run that has ended");
  }
  CheckSummary(paths, summary);
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
  // Without a slash at the end a folder has a name.
  const std::filesystem::path path =
      (std::filesystem::absolute(folder) / "").lexically_normal().parent_path();
  ReportedSolvers solvers{path.filename().string(), {}};
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
