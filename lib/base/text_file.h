#ifndef SPLITFUSION_LIB_BASE_TEXT_FILE_H_
#define SPLITFUSION_LIB_BASE_TEXT_FILE_H_

#include <fstream>
#include <string>

namespace splitfusion {

/// Opens a file of the user's for reading. A pipe is refused: it would be
/// waited for, and be empty the second time.
///
/// @throw InputError if it cannot be opened, or is no regular file.
std::ifstream OpenTextFile(const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_TEXT_FILE_H_
