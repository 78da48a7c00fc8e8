#include "splitfusion/lib/base/atomic_file.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

void WritePathAtomically(const std::string& path,
                         const std::function<void(const std::string&)>& write) {
  namespace fs = std::filesystem;
  std::error_code error;
  // A link stays, and what it names is replaced.
  const fs::path target = fs::is_symlink(path, error)
                              ? fs::weakly_canonical(path, error)
                              : fs::path(path);
  if (fs::exists(target, error) && !fs::is_regular_file(target, error)) {
    throw InputError(path + ": cannot be written: expected a regular file");
  }
  if (target.has_parent_path()) {
    fs::create_directory(target.parent_path(), error);
  }
  const fs::path temporary =
      target.parent_path() /
      ("." + target.stem().string() + ".tmp" + std::to_string(getpid()) +
       target.extension().string());
  try {
    write(temporary.string());
  } catch (...) {
    fs::remove(temporary, error);
    throw;
  }
  fs::rename(temporary, target, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    throw InputError(path + ": cannot be written (" + reason + ")");
  }
}

void WriteFileAtomically(const std::string& path,
                         const std::function<void(std::ostream&)>& write) {
  WritePathAtomically(path, [&](const std::string& temporary) {
    std::ofstream stream(temporary, std::ios::binary);
    if (stream) write(stream);
    stream.close();
    if (!stream) {
      throw InputError(path +
                       ": cannot be written (folder missing, not "
                       "writable or disk full)");
    }
  });
}

bool CanMakeFiles(const std::string& folder) {
  std::string path = folder + "/.probe-XXXXXX";
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) return false;
  close(descriptor);
  unlink(path.c_str());
  return true;
}

}  // namespace splitfusion
