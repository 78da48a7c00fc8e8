#include "splitfusion/lib/report/run_folder.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/base/random_id.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Of a run that is put into place, in its marker.
constexpr char kCheckpoint[] = "checkpoint.bin";

/// Whether it holds anything but log files and what `own` names.
bool HoldsOthers(const std::string& folder, const std::vector<fs::path>& own) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path name = entry.path().filename();
    const bool known = name.extension() == ".log" ||
                       std::find(own.begin(), own.end(), name) != own.end();
    if (!known) return true;
  }
  return false;
}

/// Whether it holds anything that a run would take for its own.
bool HoldsNamesOfRuns(const std::string& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (RunPaths::IsOfRun(entry.path().filename().string())) return true;
  }
  return false;
}

/// What a run wrote, without files of other programs.
std::map<std::string, RunFile> FilesOfRun(const std::string& folder) {
  std::map<std::string, RunFile> own;
  for (const auto& [path, file] : ListRunFiles(folder, {kCheckpoint})) {
    if (RunPaths::IsOfRun(fs::path(path).begin()->string())) own[path] = file;
  }
  return own;
}

/// Files that the next frames write again, or that only an ended run has.
bool IsOfTheEnd(const std::string& path) {
  const std::string first = fs::path(path).begin()->string();
  return first == "surfaces" || first == "refinement.jsonl" ||
         first == "hidden_deviations.csv" || first == "summary.json" ||
         first == "report.html" || first == "evaluation.json";
}

void Rename(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::create_directories(to.parent_path(), error);
  fs::rename(from, to, error);
  if (error) {
    throw InputError(to.string() + ": cannot be written (" + error.message() +
                     ")");
  }
}

/// Moves those of the files that are still in `from`. What lies at their place
/// and was not written by a run is kept under another name.
void MoveFiles(const OwnedFileList& files, const fs::path& from,
               const fs::path& to, const std::string& id) {
  for (const OwnedFile& file : files) {
    if (!fs::exists(from / file.path)) continue;
    const fs::path target = to / file.path;
    if (fs::exists(target) && !fs::is_regular_file(target)) {
      throw InputError(target.string() + ": is in the way of a file of a run");
    }
    if (fs::exists(target)) {
      Rename(target, target.string() + ".before-" + id.substr(0, 8));
    }
    Rename(from / file.path, target);
  }
}

/// What a killed program was writing: lib/base/atomic_file names it so.
void RemoveTemporaries(const std::string& folder) {
  for (const OwnedFile& file : FilesBelow(folder)) {
    const std::string name = fs::path(file.path).filename().string();
    const bool temporary =
        name.front() == '.' && name.find(".tmp") != std::string::npos;
    if (temporary) fs::remove(fs::path(folder) / file.path);
  }
}

/// Removes what an unfinished run wrote and, if nothing is left, its folder;
/// its marker last, so that a process that is killed meanwhile leaves a folder
/// that is still known for one.
void RemoveRun(const RunPaths& paths) {
  const fs::path marker(paths.Marker());
  RemoveTemporaries(paths.root());
  std::vector<fs::path> own;
  for (const auto& entry : fs::directory_iterator(paths.root())) {
    if (RunPaths::IsOfRun(entry.path().filename().string())) {
      own.push_back(entry.path());
    }
  }
  for (const fs::path& path : own) {
    if (path.filename() != marker.filename()) fs::remove_all(path);
  }
  fs::remove(marker);
  std::error_code ignored;  // Files of others stay.
  fs::remove(paths.root(), ignored);
}

}  // namespace

std::string RunFolderDamage(const std::string& root) try {
  const RunPaths paths(root);
  const std::string unfinished = paths.Unfinished();
  if (!fs::exists(root)) return "";
  const std::optional<RunMarker> begun = ReadRunMarker(unfinished);
  const bool published = ReadRunMarker(root).has_value();
  // Killed while it was put into place, it goes on.
  if (begun && begun->phase != PublishingPhase::kNone) return "";
  if (!published && HoldsOthers(root, {"lock", "unfinished"})) {
    return root +
           ": is not empty and not a run (it has no run.json): expected a new "
           "or empty folder, or a run to overwrite; move it away";
  }
  if (begun || !fs::exists(unfinished) || !HoldsNamesOfRuns(unfinished)) {
    return "";
  }
  return unfinished +
         ": is not of a run (it has no run.json): expected a folder of sf_run; "
         "move it away";
} catch (const InputError& error) {
  return std::string(error.what()) + "; move its folder away";
}

RunFolder::RunFolder(std::string root, RunIdentity identity,
                     const RunFolderOptions& options)
    : root_(std::move(root)),
      paths_(root_),
      unfinished_(paths_.Unfinished()),
      identity_(std::move(identity)) {
  MakeFolder(root_);
  Lock();
  const std::string damage = RunFolderDamage(root_);
  if (!damage.empty()) throw InputError(damage);
  Recover();
  Decide(options);
}

void RunFolder::Lock() {
  LockHolder holder;
  lock_ = DirectoryLock::TryAcquire(paths_.Lock(), &holder);
  if (lock_) return;
  throw InputError(root_ + ": is held by " + holder.ToString() +
                   ", which works on it: expected another folder, or to wait");
}

void RunFolder::CheckHeld() const {
  if (lock_ && lock_->IsHeld()) return;
  throw InputError(root_ +
                   ": was removed or taken over while the run went on: "
                   "expected the folder to stay");
}

/// A program was killed while it put a run into place: that goes on.
void RunFolder::Recover() {
  const std::optional<RunMarker> begun = ReadRunMarker(unfinished_.root());
  if (begun && begun->phase != PublishingPhase::kNone) PutInPlace(*begun);
}

void RunFolder::Decide(const RunFolderOptions& options) {
  const std::optional<RunMarker> published = ReadRunMarker(root_);
  const std::optional<RunMarker> begun = ReadRunMarker(unfinished_.root());
  const bool can_resume = options.resume && begun && begun->IsSame(identity_);
  const bool finished =
      published && published->status == RunStatus::kComplete &&
      published->IsSame(identity_) && FindMissing(*published, root_).empty();
  if (finished && (!options.overwrite || options.keep_same)) {
    marker_ = *published;
    start_ = RunStart::kFinished;
  } else if (can_resume && (options.overwrite || !published ||
                            published->IsSame(identity_))) {
    Resume(*begun);
  } else {
    DecideBesides(published, begun, options);
  }
}

void RunFolder::DecideBesides(const std::optional<RunMarker>& published,
                              const std::optional<RunMarker>& begun,
                              const RunFolderOptions& options) {
  const std::optional<RunMarker>& older = published ? published : begun;
  if (older) {
    const std::string changes = Differences(older->identity, identity_);
    const std::string missing =
        published ? FindMissing(*published, root_) : std::string();
    const std::string what =
        // Who marked it as running holds the folder no more.
        "a run that is " +
        (older->status == RunStatus::kRunning ? "unfinished"
                                              : ToString(older->status)) +
        (changes.empty() ? "" : ", of other options (" + changes + ")") +
        (missing.empty() ? "" : ", but " + missing);
    const bool again = changes.empty() && !published;
    if (!options.overwrite && !again) {
      throw InputError(root_ + ": holds " + what +
                       ": expected --overwrite, or another folder");
    }
    note_ = "replaces " + what;
  }
  Begin();
}

void RunFolder::RemoveUnfinished() {
  if (fs::exists(unfinished_.root())) RemoveRun(unfinished_);
}

void RunFolder::Begin() {
  RemoveUnfinished();
  MakeFolder(unfinished_.root());
  start_ = RunStart::kFresh;
  marker_ = RunMarker();
  marker_.id = RandomId();
  marker_.identity = identity_;
  WriteRunMarker(unfinished_.root(), marker_);
}

void RunFolder::Resume(RunMarker begun) {
  // What an interruption put into place goes back, but for what only the end
  // of a run has.
  const std::optional<RunMarker> published = ReadRunMarker(root_);
  if (published && published->id == begun.id) {
    OwnedFileList back, gone;
    for (const OwnedFile& file : published->Owned()) {
      (IsOfTheEnd(file.path) ? gone : back).push_back(file);
    }
    RemoveOwnedFiles(root_, gone);
    MoveFiles(back, root_, unfinished_.root(), begun.id);
    RemoveOwnedFiles(root_, published->Owned());  // Their folders.
    fs::remove(paths_.Marker());
  }
  RemoveTemporaries(unfinished_.root());
  marker_ = std::move(begun);
  const bool killed = marker_.status == RunStatus::kRunning;
  marker_.status = RunStatus::kRunning;
  marker_.error.clear();
  WriteRunMarker(unfinished_.root(), marker_);
  start_ = fs::exists(unfinished_.Checkpoint()) ? RunStart::kResumed
                                                : RunStart::kFresh;
  if (start_ == RunStart::kFresh) {
    StartAfresh(killed ? "killed before a checkpoint"
                       : "begins anew: had ended before a checkpoint");
  }
}

void RunFolder::StartAfresh(const std::string& why) {
  note_ = why;
  Begin();
}

void RunFolder::RecordResumption(int frame) {
  marker_.resumed_at.push_back(frame);
  WriteRunMarker(unfinished_.root(), marker_);
}

bool RunFolder::Publish(RunStatus status, const std::string& error) {
  CheckHeld();
  marker_.status = status;
  marker_.error = error;
  const std::optional<RunMarker> older = ReadRunMarker(root_);
  const bool complete = status == RunStatus::kComplete;
  if (!complete && older && older->status == RunStatus::kComplete) {
    WriteRunMarker(unfinished_.root(), marker_);
    return false;
  }
  marker_.files = FilesOfRun(unfinished_.root());
  marker_.phase = PublishingPhase::kRemoving;
  WriteRunMarker(unfinished_.root(), marker_);
  PutInPlace(marker_);
  marker_.phase = PublishingPhase::kNone;
  return true;
}

void RunFolder::RecordFailure(const std::string& error) noexcept {
  try {
    CheckHeld();
    std::optional<RunMarker> begun = ReadRunMarker(unfinished_.root());
    if (!begun || begun->phase != PublishingPhase::kNone) return;
    begun->status = RunStatus::kFailed;
    begun->error = error;
    WriteRunMarker(unfinished_.root(), *begun);
  } catch (const std::exception&) {
    // A full disk takes no marker either: the run stays "running" there, and
    // the next process sees that no other holds it.
  }
}

void RunFolder::PutInPlace(RunMarker marker) {
  if (marker.phase == PublishingPhase::kRemoving) {
    const std::optional<RunMarker> older = ReadRunMarker(root_);
    if (older) RemoveOwnedFiles(root_, older->Owned());
    fs::remove(paths_.Marker());
    marker.phase = PublishingPhase::kMoving;
    WriteRunMarker(unfinished_.root(), marker);
  }
  MoveFiles(marker.Owned(), unfinished_.root(), root_, marker.id);
  marker.phase = PublishingPhase::kNone;
  WriteRunMarker(root_, marker);
  if (marker.status == RunStatus::kComplete) {
    RemoveRun(unfinished_);
    return;
  }
  marker.files.clear();
  WriteRunMarker(unfinished_.root(), marker);
  RemoveEmptyTree(unfinished_.root());
}

}  // namespace splitfusion
