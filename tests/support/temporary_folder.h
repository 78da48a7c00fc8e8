#ifndef SPLITFUSION_TESTS_SUPPORT_TEMPORARY_FOLDER_H_
#define SPLITFUSION_TESTS_SUPPORT_TEMPORARY_FOLDER_H_

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace splitfusion {

/// An empty folder that is removed with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name =
        (std::filesystem::temp_directory_path() / "splitfusion_XXXXXX")
            .string();
    if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp failed");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Path of an entry; of the folder itself for an empty name.
  std::string operator/(const std::string& name) const {
    return (path_ / name).string();
  }

  /// Writes a file, with its folders; returns its path.
  std::string Write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return *this / name;
  }

  /// Makes a folder; returns its path.
  std::string Make(const std::string& name) const {
    std::filesystem::create_directories(path_ / name);
    return *this / name;
  }

  /// Whole content of a file; empty if it is missing.
  std::string Read(const std::string& name) const {
    std::ifstream stream(path_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// Whether an entry exists.
  bool Has(const std::string& name) const {
    return std::filesystem::exists(path_ / name);
  }

 private:
  std::filesystem::path path_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_TEMPORARY_FOLDER_H_
