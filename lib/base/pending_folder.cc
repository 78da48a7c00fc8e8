#include "splitfusion/lib/base/pending_folder.h"

#include <fcntl.h>
#include <stdio.h>

#include <system_error>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/random_id.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Links resolved, so that a folder is replaced, not the link to it.
fs::path ResolvedPath(const std::string& directory) {
  if (directory.empty()) {
    throw InputError("directory = '': expected the folder to write");
  }
  std::error_code error;
  fs::path path = fs::weakly_canonical(fs::absolute(directory), error);
  if (error) throw InputError(directory + ": " + error.message());
  return path.has_filename() ? path : path.parent_path();
}

bool Exists(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

/// Each gets the other's name.
bool Exchange(const fs::path& a, const fs::path& b) {
  return renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) ==
         0;
}

/// The same in three steps, for file systems that cannot do it in one.
///
/// @throw fs::filesystem_error, both folders as they were.
void ExchangeInSteps(const fs::path& a, const fs::path& b) {
  const fs::path between = a.string() + ".old";
  fs::rename(b, between);
  std::error_code error;
  fs::rename(a, b, error);
  if (error) {
    fs::rename(between, b);
    throw fs::filesystem_error("", error);
  }
  fs::rename(between, a);
}

/// Moves a file to the same place below another folder.
void Move(const std::string& file, const fs::path& from, const fs::path& to) {
  fs::create_directories((to / file).parent_path());
  fs::rename(from / file, to / file);
}

}  // namespace

PendingFolder::PendingFolder(const std::string& directory,
                             const std::string& program, bool overwrite)
    : program_(program), target_(ResolvedPath(directory)) {
  CheckTarget(overwrite);
  const fs::path temporary =
      target_.parent_path() /
      ("." + target_.filename().string() + ".partial-" + RandomId());
  std::error_code error;
  fs::create_directories(temporary, error);
  if (error) Fail(error.message());
  temporary_ = temporary;
}

PendingFolder::~PendingFolder() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

std::vector<std::string> PendingFolder::Commit() {
  const std::string marker = program_ + ".json";
  WriteOwnershipMarker(temporary_ / marker,
                       {program_, RandomId(), FilesBelow(temporary_.string())});
  std::vector<std::string> kept = FilesToKeep();
  try {
    TakePlace();
    RemoveOld(kept);
  } catch (const fs::filesystem_error& error) {
    Fail(error.code().message());
  }
  return kept;
}

void PendingFolder::CheckTarget(bool overwrite) {
  std::error_code error;
  if (!fs::exists(target_, error)) return;
  if (!fs::is_directory(target_)) {
    throw InputError(target_.string() + ": is a file, expected a folder");
  }
  if (fs::is_empty(target_, error)) return;
  if (error) Fail(error.message());
  if (!overwrite) {
    throw InputError(target_.string() +
                     ": exists and is not empty; expected a new folder, or "
                     "the option to overwrite");
  }
  old_ = ReadOld();
  CheckOldFiles();
}

std::optional<OwnershipMarker> PendingFolder::ReadOld() const {
  const std::string marker = program_ + ".json";
  auto old = ReadOwnershipMarker((target_ / marker).string());
  if (!old || old->program != program_) {
    throw InputError(target_.string() + ": not overwritten, for " + program_ +
                     " did not write it (no " + marker + " of it)");
  }
  std::error_code error;
  old->files.push_back({marker, fs::file_size(target_ / marker, error)});
  return old;
}

void PendingFolder::CheckOldFiles() const {
  for (const OwnedFile& file : old_->files) {
    if (!Exists(target_ / file.path)) continue;
    if (IsAsWritten(target_.string(), file)) continue;
    throw InputError((target_ / file.path).string() +
                     ": not overwritten, for it was changed since " + program_ +
                     " wrote it; expected it to be moved away first");
  }
}

std::vector<std::string> PendingFolder::FilesToKeep() const {
  if (!old_) return {};
  if (ReadOld()->id != old_->id) {
    Fail("another program has replaced it meanwhile");
  }
  CheckOldFiles();
  std::vector<std::string> kept = ForeignFiles(target_.string(), old_->files);
  for (const std::string& file : kept) {
    for (fs::path at = file; !at.empty(); at = at.parent_path()) {
      if (!Exists(temporary_ / at)) continue;
      if (at != file && fs::is_directory(temporary_ / at)) break;
      throw InputError((target_ / file).string() + ": not overwritten, for " +
                       program_ + " did not write it");
    }
  }
  return kept;
}

/// An empty folder is replaced by a plain rename, which fails if there is
/// something in it by now.
void PendingFolder::TakePlace() {
  if (!old_) {
    fs::rename(temporary_, target_);
    temporary_.clear();
  } else if (!Exchange(temporary_, target_)) {
    ExchangeInSteps(temporary_, target_);
  }
}

/// From here on `temporary_` is the older folder, of which nothing may be
/// removed but what the list names.
void PendingFolder::RemoveOld(const std::vector<std::string>& kept) {
  if (!old_) return;
  const fs::path old = std::exchange(temporary_, fs::path());
  for (const std::string& file : kept) Move(file, old, target_);
  RemoveOwnedFiles(old.string(), old_->files);
  RemoveEmptyTree(old.string());
}

void PendingFolder::Fail(const std::string& reason) const {
  throw InputError(target_.string() + ": cannot be written (" + reason + ")");
}

}  // namespace splitfusion
