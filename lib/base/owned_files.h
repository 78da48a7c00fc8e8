#ifndef SPLITFUSION_LIB_BASE_OWNED_FILES_H_
#define SPLITFUSION_LIB_BASE_OWNED_FILES_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace splitfusion {

/// A file that a program wrote into a folder of its own.
struct OwnedFile {
  std::string path;          ///< Relative to the folder, '/' between names.
  std::uintmax_t bytes = 0;  ///< Size as it was written.
};

/// What a program wrote into a folder.
using OwnedFileList = std::vector<OwnedFile>;

/// All regular files below a folder, sorted by path; symbolic links are neither
/// followed nor listed. For a folder that a program has just made itself.
///
/// @throw InputError if the folder cannot be read.
OwnedFileList FilesBelow(const std::string& folder);

/// Whether `file` still is what was written: a regular file of that size that
/// lies inside `folder`. Never true of paths that lead out of the folder, with
/// `..` or over a symbolic link.
bool IsAsWritten(const std::string& folder, const OwnedFile& file);

/// What lies below a folder and is not as one of `files` was written: files of
/// others, changed files, links, ...; sorted relative paths, no folders.
///
/// @throw InputError if the folder cannot be read.
std::vector<std::string> ForeignFiles(const std::string& folder,
                                      const OwnedFileList& files);

/// Deletes those of `files` that are as they were written, and then the folders
/// they lay in, below `folder`, as far as these are empty. All else stays:
/// changed files too, whose paths are returned. Missing files are fine.
///
/// @throw InputError if a file cannot be deleted.
std::vector<std::string> RemoveOwnedFiles(const std::string& folder,
                                          const OwnedFileList& files);

/// Removes a folder and those below it as far as they hold no file.
void RemoveEmptyTree(const std::string& folder);

/// The marker that a program leaves in a folder: what of it is its own. It is
/// not in its own list.
struct OwnershipMarker {
  std::string program;  ///< Who wrote the files.
  std::string id;       ///< RandomId() of this writing.
  OwnedFileList files;  ///< What it wrote.
};

/// Writes a marker as a JSON object: format_version, program, id, files: a list
/// of path and bytes.
///
/// @throw InputError if the file cannot be written.
void WriteOwnershipMarker(const std::string& path,
                          const OwnershipMarker& marker);

/// Reads what WriteOwnershipMarker() wrote; empty if there is no such file.
///
/// @throw InputError if it is broken, of a later version, or names a path that
///     leads out of the folder.
std::optional<OwnershipMarker> ReadOwnershipMarker(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_OWNED_FILES_H_
