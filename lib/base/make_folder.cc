#include "splitfusion/lib/base/make_folder.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void MakeFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && std::filesystem::is_directory(folder, error)) return;
  throw InputError(folder + ": cannot be made (" +
                   (error ? error.message() : "not a directory") +
                   "): expected a folder, or a place for one");
}

}  // namespace splitfusion
