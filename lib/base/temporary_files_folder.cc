#include "splitfusion/lib/base/temporary_files_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

std::string TemporaryFilesFolder() {
  std::error_code error;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path(error);
  if (!error) return folder.string();
  const char* name = std::getenv("TMPDIR");
  throw InputError(std::string("TMPDIR = '") + (name == nullptr ? "" : name) +
                   "': expected a folder for temporary files");
}

}  // namespace splitfusion
