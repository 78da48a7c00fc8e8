#include "splitfusion/lib/report/run_directory.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/peak_memory.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/report/html_report.h"
#include "splitfusion/lib/report/iterations_csv.h"
#include "splitfusion/lib/report/report_json.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

bool IsUsed(const std::string& root) {
  for (const auto& entry : fs::directory_iterator(root)) {
    if (entry.path().extension() != ".log") return true;
  }
  return false;
}

/// All that a run writes.
std::vector<std::string> Contents(const RunPaths& paths) {
  std::vector<std::string> contents = {paths.Options(),    paths.Calibration(),
                                       paths.Trajectory(), paths.Frames(),
                                       paths.Iterations(), paths.Summary(),
                                       paths.Evaluation(), paths.HtmlReport()};
  for (const char* folder :
       {"surfaces", "pictures", "masks", "detections", "solver"}) {
    contents.push_back((fs::path(paths.root()) / folder).string());
  }
  return contents;
}

/// @throw InputError if clearing the folder would delete what no run wrote.
void CheckIsRun(const RunPaths& paths) {
  if (fs::exists(paths.Options())) return;
  for (const std::string& path : Contents(paths)) {
    if (fs::exists(path)) {
      throw InputError(path + ": is not of a run, for " + paths.Options() +
                       " is missing; expected a run directory to overwrite");
    }
  }
}

void MakeRoot(const std::string& root, bool overwrite) {
  std::error_code error;
  fs::create_directories(root, error);
  if (error || !fs::is_directory(root)) {
    throw InputError(root + ": cannot be made a run directory (" +
                     (error ? error.message() : "not a directory") + ")");
  }
  if (!IsUsed(root)) return;
  if (overwrite) {
    CheckIsRun(RunPaths(root));
    ClearRun(RunPaths(root));
  } else {
    throw InputError(root +
                     ": is not empty: expected a new or empty run "
                     "directory, or --overwrite");
  }
}

void Open(const std::string& path, std::ofstream* stream) {
  stream->open(path, std::ios::binary | std::ios::trunc);
  if (!*stream) throw InputError(path + ": cannot be written");
}

void Flush(const std::string& path, std::ofstream* stream) {
  stream->flush();
  if (!*stream) throw InputError(path + ": cannot be written (disk full?)");
}

std::string OptionsText(const RunFacts& facts) {
  std::string text;
  for (const auto& [library, version] : facts.versions) {
    text += "# " + library + " " + version + "\n";
  }
  text += facts.options;
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

/// Ceres' texts of all minimisations of a frame; empty if none were asked for.
std::string SolverTexts(const FrameReport& report) {
  std::string text;
  for (const SurfaceReport& surface : report.surfaces) {
    int number = 0;
    for (const TrackingRound& round : surface.rounds) {
      if (!round.solver.full_report.empty()) {
        text += "== surface " + std::to_string(surface.id) + " (" +
                surface.label + "), round " + std::to_string(number) + ", " +
                round.stage + "\n" + round.solver.full_report + "\n";
      }
      ++number;
    }
  }
  return text;
}

void WriteText(const std::string& path, const std::string& text) {
  WriteFileAtomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace

void ClearRun(const RunPaths& paths) {
  std::error_code ignored;
  for (const std::string& path : Contents(paths)) {
    fs::remove_all(path, ignored);
  }
}

bool IsComplete(const RunPaths& paths) {
  std::ifstream stream(paths.Summary());
  const auto summary = nlohmann::json::parse(stream, nullptr, false);
  return summary.is_object() && summary.value("complete", false);
}

RunDirectory::RunDirectory(const std::string& root, bool overwrite,
                           RunFacts facts)
    : paths_(root), facts_(std::move(facts)) {
  MakeRoot(root, overwrite);
  WriteText(paths_.Options(), OptionsText(facts_));
  OpenStreams();
}

void RunDirectory::OpenStreams() {
  Open(paths_.Frames(), &frames_);
  Open(paths_.Iterations(), &iterations_);
  Open(paths_.Trajectory(), &trajectory_);
  WriteIterationsHeader(iterations_);
  WriteTumHeader(trajectory_);
  Flush(paths_.Iterations(), &iterations_);
  Flush(paths_.Trajectory(), &trajectory_);
}

void RunDirectory::AddFrame(const FrameReport& report, const TimedPose& pose) {
  const Stopwatch stopwatch;
  builder_.Add(report);
  frames_ << JsonText(ToJson(report)) << '\n';
  Flush(paths_.Frames(), &frames_);
  WriteIterations(iterations_, report);
  Flush(paths_.Iterations(), &iterations_);
  WriteTumPose(trajectory_, pose);
  Flush(paths_.Trajectory(), &trajectory_);
  const std::string texts = SolverTexts(report);
  if (!texts.empty()) WriteText(paths_.SolverReport(report.frame), texts);
  seconds_writing_ += stopwatch.Seconds();
}

RunSummary RunDirectory::Summary() const {
  RunSummary summary = builder_.Build();
  summary.preset = facts_.preset;
  summary.versions = facts_.versions;
  summary.seconds_writing = seconds_writing_;
  summary.peak_memory_bytes = PeakMemoryBytes();
  return summary;
}

void RunDirectory::Finish(bool complete) const {
  RunSummary facts = Summary();
  facts.complete = complete;
  const nlohmann::ordered_json summary = ToJson(facts);
  WriteHtmlReport(paths_, summary);
  WriteText(paths_.Summary(), JsonText(summary, 2) + "\n");
}

}  // namespace splitfusion
