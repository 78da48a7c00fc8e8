#ifndef SPLITFUSION_TESTS_SUPPORT_SHARED_DATA_H_
#define SPLITFUSION_TESTS_SUPPORT_SHARED_DATA_H_

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/repository.h"

namespace splitfusion {

/// Path of an entry of the optional shared folder, $SPLITFUSION_SHARED, or else
/// `shared` beside the repository. Empty if the entry is not there.
inline std::string SharedEntry(const std::string& name) {
  namespace fs = std::filesystem;
  const char* folder = std::getenv("SPLITFUSION_SHARED");
  const fs::path root =
      folder != nullptr ? fs::path(folder) : RepositoryRoot() / "../shared";
  const fs::path path = (root / name).lexically_normal();
  return fs::exists(path) ? path.string() : std::string();
}

/// Path of a shared sequence, or empty.
inline std::string SharedData(const std::string& name) {
  return SharedEntry("data/" + name);
}

/// Path of a shared network, or empty.
inline std::string SharedModel(const std::string& name) {
  return SharedEntry("models/" + name);
}

}  // namespace splitfusion

/// Skips the test, and says so, unless `path` (of SharedData, SharedModel) is
/// there.
#define SKIP_WITHOUT_SHARED_DATA(path, name)                   \
  if ((path).empty()) {                                        \
    GTEST_SKIP() << "shared data not found: " << (name)        \
                 << " (set SPLITFUSION_SHARED to its folder)"; \
  }

#endif  // SPLITFUSION_TESTS_SUPPORT_SHARED_DATA_H_
