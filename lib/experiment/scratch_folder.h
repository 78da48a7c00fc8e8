#ifndef SPLITFUSION_LIB_EXPERIMENT_SCRATCH_FOLDER_H_
#define SPLITFUSION_LIB_EXPERIMENT_SCRATCH_FOLDER_H_

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/temporary_files_folder.h"

namespace splitfusion {

/// An empty folder among the temporary ones; removed with the object.
class ScratchFolder {
 public:
  /// @throw InputError if it cannot be made.
  ScratchFolder() {
    path_ = TemporaryFilesFolder() + "/sf_batch_XXXXXX";
    if (mkdtemp(path_.data()) == nullptr) {
      throw InputError(path_ + ": cannot be made; expected a TMPDIR to write");
    }
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /// Where it is.
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_SCRATCH_FOLDER_H_
