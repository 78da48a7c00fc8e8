#include "splitfusion/lib/report/run_directory.h"

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/archive.h"
#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/owned_files.h"
#include "splitfusion/lib/base/process_memory.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/report/iterations_csv.h"
#include "splitfusion/lib/report/report_json.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// To be written on at its end.
void Open(const std::string& path, std::ofstream* stream) {
  stream->open(path, std::ios::binary | std::ios::app | std::ios::ate);
  if (!*stream) throw InputError(path + ": cannot be written");
}

/// Opens a stream that held so many bytes, and maybe more since.
void CutTo(const std::string& path, std::uint64_t size, std::ofstream* stream) {
  std::error_code error;
  if (fs::file_size(path, error) < size || error) {
    throw InputError(path + ": is shorter than at the checkpoint: expected " +
                     std::to_string(size) + " bytes");
  }
  stream->close();
  fs::resize_file(path, size);
  Open(path, stream);
}

/// What was written beside the streams so far, by path relative to `root`, with
/// sizes. Masks of a network are left out: those of the next frame may be
/// written at this moment, in another thread.
std::map<std::string, std::uint64_t> FilesBeside(const std::string& root) {
  std::map<std::string, std::uint64_t> files;
  for (const char* name : {"checkpoints", "masks", "pictures", "solver"}) {
    const std::string folder = (fs::path(root) / name).string();
    if (!fs::is_directory(folder)) continue;
    for (const OwnedFile& file : FilesBelow(folder)) {
      files[std::string(name) + "/" + file.path] = file.bytes;
    }
  }
  return files;
}

void CheckFilesBeside(const std::string& root,
                      const std::map<std::string, std::uint64_t>& files) {
  for (const auto& [path, size] : files) {
    const std::string file = (fs::path(root) / path).string();
    std::error_code error;
    if (fs::file_size(file, error) < size || error) {
      throw InputError(file +
                       ": is missing or shorter than at the "
                       "checkpoint: expected " +
                       std::to_string(size) + " bytes");
    }
  }
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

bool IsComplete(const RunPaths& paths) {
  const nlohmann::ordered_json summary = ReadVersionedOrNull(paths.Summary());
  return summary.is_object() && summary.contains("complete") &&
         summary["complete"] == true;
}

RunDirectory::RunDirectory(const std::string& root, RunFacts facts,
                           bool goes_on)
    : paths_(root), facts_(std::move(facts)) {
  WriteText(paths_.Options(), OptionsText(facts_));
  for (const auto& [path, stream] : Streams()) {
    if (!goes_on) fs::remove(path);
    Open(path, stream);
  }
  WriteHeads();
}

std::vector<std::pair<std::string, std::ofstream*>> RunDirectory::Streams() {
  return {{paths_.Frames(), &frames_},
          {paths_.Iterations(), &iterations_},
          {paths_.Trajectory(), &trajectory_}};
}

void RunDirectory::WriteHeads() {
  if (iterations_.tellp() == 0) WriteIterationsHeader(iterations_);
  if (trajectory_.tellp() == 0) WriteTumHeader(trajectory_);
  Flush(paths_.Iterations(), &iterations_);
  Flush(paths_.Trajectory(), &trajectory_);
}

template <typename Archive>
void RunDirectory::Serialize(Archive* archive) {
  archive->Section("run directory");
  RunTime time = Time();
  (*archive)(builder_, seconds_writing_, time.wall, time.cpu);
  if constexpr (Archive::kReads) time_before_ = time;
  for (const auto& [path, stream] : Streams()) {
    std::uint64_t size = stream->tellp();
    (*archive)(size);
    if constexpr (Archive::kReads) CutTo(path, size, stream);
  }
  auto files = FilesBeside(paths_.root());
  (*archive)(files);
  if constexpr (Archive::kReads) CheckFilesBeside(paths_.root(), files);
}

template void RunDirectory::Serialize(ArchiveWriter*);
template void RunDirectory::Serialize(ArchiveReader*);

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

void RunDirectory::WriteTrajectory(const Trajectory& trajectory) const {
  const auto added =
      std::min(static_cast<std::size_t>(Summary().frames), trajectory.size());
  WriteTumTrajectory(paths_.Trajectory(),
                     {trajectory.end() - static_cast<std::ptrdiff_t>(added),
                      trajectory.end()});
}

RunTime RunDirectory::Time() const {
  return {
      time_before_.wall + facts_.since_start.Seconds(),
      time_before_.cpu + static_cast<double>(std::clock()) / CLOCKS_PER_SEC};
}

RunSummary RunDirectory::Summary() const {
  RunSummary summary = builder_.Build();
  summary.preset = facts_.preset;
  summary.versions = facts_.versions;
  summary.seconds_writing = seconds_writing_;
  summary.seconds_refining = seconds_refining_;
  summary.seconds_coloring = seconds_coloring_;
  const RunTime time = Time();
  const int frames = std::max(1, summary.frames);
  summary.all_seconds_per_frame = time.wall / frames;
  summary.cpu_seconds_per_frame = time.cpu / frames;
  summary.peak_memory_bytes = PeakMemoryBytes();
  return summary;
}

void RunDirectory::Finish(const RunEnding& ending,
                          const PageWriter& write_page) const {
  RunSummary facts = Summary();
  facts.complete = ending.status == RunStatus::kComplete;
  facts.status = ToString(ending.status);
  facts.error = ending.error;
  facts.resumed_at = ending.resumed_at;
  facts.skipped_frames = ending.skipped_frames;
  facts.loops = ending.loops;
  const nlohmann::ordered_json summary = ToJson(facts);
  if (write_page) write_page(paths_, summary);
  WriteJson(paths_.Summary(), Versioned(summary), 2);
}

}  // namespace splitfusion
