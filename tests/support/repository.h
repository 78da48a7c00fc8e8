#ifndef SPLITFUSION_TESTS_SUPPORT_REPOSITORY_H_
#define SPLITFUSION_TESTS_SUPPORT_REPOSITORY_H_

#include <filesystem>

namespace splitfusion {

/// Folder of the test program and of the tools, `bin` of the build.
inline std::filesystem::path ProgramFolder() {
  return std::filesystem::read_symlink("/proc/self/exe").parent_path();
}

/// Root of the repository, found above the test program; the root of the file
/// system if the build is not inside the repository.
inline std::filesystem::path RepositoryRoot() {
  std::filesystem::path folder = ProgramFolder();
  while (folder != folder.root_path() &&
         !std::filesystem::exists(folder / "CMakePresets.json")) {
    folder = folder.parent_path();
  }
  return folder;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_REPOSITORY_H_
