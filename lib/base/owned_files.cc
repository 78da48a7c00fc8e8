#include "splitfusion/lib/base/owned_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <system_error>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Relative, and without names that lead elsewhere.
bool IsPathInside(const fs::path& path) {
  return !path.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& name) {
           return name.empty() || name == "." || name == "..";
         });
}

/// Whether every folder between `folder` and the file is a real one: what lies
/// behind a link was not written here.
bool LiesInRealFolders(const fs::path& folder, const fs::path& file) {
  fs::path above = folder;
  for (const fs::path& name : file.parent_path()) {
    above /= name;
    std::error_code ignored;
    if (!fs::is_directory(fs::symlink_status(above, ignored))) return false;
  }
  return true;
}

/// Calls `see` for everything below a folder but folders.
void ForEachEntry(const std::string& folder,
                  const std::function<void(const fs::directory_entry&)>& see) {
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!fs::is_directory(entry.symlink_status())) see(entry);
    }
  } catch (const fs::filesystem_error& error) {
    throw InputError(folder + ": cannot be read (" + error.code().message() +
                     ")");
  }
}

std::string RelativePath(const fs::path& path, const std::string& folder) {
  return path.lexically_relative(folder).generic_string();
}

/// Folders that the files lie in, deepest first.
std::vector<std::string> FoldersOf(const OwnedFileList& files) {
  std::set<std::string> folders;
  for (const OwnedFile& file : files) {
    fs::path above = fs::path(file.path).parent_path();
    for (; !above.empty(); above = above.parent_path()) {
      if (!folders.insert(above.generic_string()).second) break;
    }
  }
  // A folder sorts after those above it.
  return {folders.rbegin(), folders.rend()};
}

void RemoveEmptyFolders(const fs::path& folder, const OwnedFileList& files) {
  for (const std::string& name : FoldersOf(files)) {
    std::error_code ignored;
    const bool is_real = LiesInRealFolders(folder, fs::path(name) / "x");
    // Fails, as it should, on a folder that is not empty.
    if (is_real) fs::remove(folder / name, ignored);
  }
}

OwnedFile ParseFile(const std::string& path, const Json& json) {
  OwnedFile file{json.at("path").get<std::string>(),
                 json.at("bytes").get<std::uintmax_t>()};
  if (IsPathInside(file.path)) return file;
  throw InputError(path + ": names '" + file.path +
                   "': expected paths inside the folder");
}

}  // namespace

OwnedFileList FilesBelow(const std::string& folder) {
  OwnedFileList files;
  ForEachEntry(folder, [&](const fs::directory_entry& entry) {
    if (!fs::is_regular_file(entry.symlink_status())) return;
    files.push_back({RelativePath(entry.path(), folder), entry.file_size()});
  });
  std::sort(
      files.begin(), files.end(),
      [](const OwnedFile& a, const OwnedFile& b) { return a.path < b.path; });
  return files;
}

bool IsAsWritten(const std::string& folder, const OwnedFile& file) {
  if (!IsPathInside(file.path) || !LiesInRealFolders(folder, file.path)) {
    return false;
  }
  std::error_code error;
  const fs::path path = fs::path(folder) / file.path;
  return fs::is_regular_file(fs::symlink_status(path, error)) &&
         fs::file_size(path, error) == file.bytes && !error;
}

std::vector<std::string> ForeignFiles(const std::string& folder,
                                      const OwnedFileList& files) {
  std::set<std::string> own;
  for (const OwnedFile& file : files) {
    if (IsAsWritten(folder, file)) own.insert(file.path);
  }
  std::vector<std::string> foreign;
  ForEachEntry(folder, [&](const fs::directory_entry& entry) {
    const std::string path = RelativePath(entry.path(), folder);
    if (own.count(path) == 0) foreign.push_back(path);
  });
  std::sort(foreign.begin(), foreign.end());
  return foreign;
}

std::vector<std::string> RemoveOwnedFiles(const std::string& folder,
                                          const OwnedFileList& files) {
  std::vector<std::string> changed;
  for (const OwnedFile& file : files) {
    const fs::path path = fs::path(folder) / file.path;
    std::error_code error;
    if (IsAsWritten(folder, file)) {
      fs::remove(path, error);
      if (error) {
        throw InputError(path.string() + ": cannot be deleted (" +
                         error.message() + ")");
      }
    } else if (fs::exists(fs::symlink_status(path, error))) {
      changed.push_back(file.path);
    }
  }
  RemoveEmptyFolders(folder, files);
  return changed;
}

void RemoveEmptyTree(const std::string& folder) {
  std::vector<fs::path> folders = {folder};
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (fs::is_directory(entry.symlink_status())) folders.push_back(entry);
  }
  std::sort(folders.rbegin(), folders.rend());
  std::error_code ignored;  // Those that are not empty stay.
  for (const fs::path& path : folders) fs::remove(path, ignored);
}

void WriteOwnershipMarker(const std::string& path,
                          const OwnershipMarker& marker) {
  Json files = Json::array();
  for (const OwnedFile& file : marker.files) {
    files.push_back({{"path", file.path}, {"bytes", file.bytes}});
  }
  const Json json = {{"format_version", kFormatVersion},
                     {"program", marker.program},
                     {"id", marker.id},
                     {"files", files}};
  WriteJson(path, json, 1);
}

std::optional<OwnershipMarker> ReadOwnershipMarker(const std::string& path) {
  if (!std::ifstream(path)) return std::nullopt;
  const Json json = ReadVersionedOrNull(path);
  OwnershipMarker marker;
  try {
    marker.program = json.at("program").get<std::string>();
    marker.id = json.at("id").get<std::string>();
    for (const Json& file : json.at("files")) {
      marker.files.push_back(ParseFile(path, file));
    }
  } catch (const Json::exception&) {
    throw InputError(path +
                     ": expected a list of the files that a program wrote, a "
                     "JSON object with format_version, program, id and files");
  }
  return marker;
}

}  // namespace splitfusion
