#ifndef SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_
#define SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_

#include <string>

namespace splitfusion {

/// The folder of temporary files: TMPDIR, or else /tmp.
///
/// @throw InputError if it is no folder.
std::string TemporaryFilesFolder();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_TEMPORARY_FILES_FOLDER_H_
