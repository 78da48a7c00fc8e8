#include "splitfusion/lib/base/text_file.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

std::ifstream OpenTextFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) &&
      !std::filesystem::is_regular_file(status)) {
    throw InputError(path + ": is no regular file: expected a text file");
  }
  std::ifstream stream(path);
  if (!stream) throw InputError(path + ": cannot be opened");
  return stream;
}

}  // namespace splitfusion
