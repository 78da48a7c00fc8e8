#ifndef SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_
#define SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_

#include <string>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

/// The folder of temporary files does not do, or has no room: whatever was
/// being read is not to blame.
class TemporaryFileError : public InputError {
 public:
  using InputError::InputError;
};

/// The folder of temporary files: TMPDIR, or else /tmp.
///
/// @throw TemporaryFileError if it is no folder.
std::string TemporaryFilesFolder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_
