#ifndef SPLITFUSION_LIB_BASE_MAKE_FOLDER_H_
#define SPLITFUSION_LIB_BASE_MAKE_FOLDER_H_

#include <string>

namespace splitfusion {

/// Makes a folder, and those above it, unless it is there.
///
/// @throw InputError if it cannot be made, or is no folder.
void MakeFolder(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_MAKE_FOLDER_H_
