#include "splitfusion/lib/base/temporary_files_folder.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace splitfusion {

std::string TemporaryFilesFolder() {
  const char* name = std::getenv("TMPDIR");
  if (name != nullptr && *name == '\0') return "/tmp";  // As if it were unset.
  std::error_code error;
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path(error);
  if (!error) return folder.string();
  throw TemporaryFileError(std::string("TMPDIR = '") +
                           (name == nullptr ? "" : name) +
                           "': expected a folder for temporary files");
}

}  // namespace splitfusion
