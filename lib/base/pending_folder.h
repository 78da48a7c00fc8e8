#ifndef SPLITFUSION_LIB_BASE_PENDING_FOLDER_H_
#define SPLITFUSION_LIB_BASE_PENDING_FOLDER_H_

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/base/owned_files.h"

namespace splitfusion {

/// A folder that appears under its final name only when it is whole: it is
/// written beside, as `.NAME.partial-ID`, and takes the place of an older one
/// of the same program in one step. What others put into the older one is kept;
/// a failure leaves the older one as it was and removes the new one.
class PendingFolder {
 public:
  /// `directory`: the final name. `program`: its writer; the marker that lists
  /// its files is `PROGRAM.json` in the folder. `overwrite`: an older folder of
  /// this program may be replaced.
  ///
  /// @throw InputError if something is in the way: a file, a folder that is not
  ///     empty and was not written by `program` (or not `overwrite`), or whose
  ///     files were changed since; or if the folder cannot be made.
  PendingFolder(const std::string& directory, const std::string& program,
                bool overwrite);
  ~PendingFolder();
  PendingFolder(const PendingFolder&) = delete;
  PendingFolder& operator=(const PendingFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& path() const { return temporary_; }

  /// Gives the folder its name. Returns the files of others that were in the
  /// older folder and now are in this one, relative paths.
  ///
  /// @throw InputError if that cannot be done, the older folder has become
  ///     another one meanwhile, or a file of others has the name of a new one.
  std::vector<std::string> Commit();

 private:
  void CheckTarget(bool overwrite);
  void CheckOldFiles() const;
  /// The list of what lies at the target; none if there is nothing.
  std::optional<OwnershipMarker> ReadOld() const;
  std::vector<std::string> FilesToKeep() const;
  void TakePlace();
  void RemoveOld(const std::vector<std::string>& kept);
  [[noreturn]] void Fail(const std::string& reason) const;

  std::string program_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  // Empty when done.
  std::optional<OwnershipMarker> old_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_PENDING_FOLDER_H_
