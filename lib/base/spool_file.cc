#include "splitfusion/lib/base/spool_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "splitfusion/lib/base/temporary_files_folder.h"

namespace splitfusion {
namespace {

[[noreturn]] void FailSpooling(const std::string& what) {
  throw TemporaryFileError(
      TemporaryFilesFolder() + ": temporary file cannot be " + what + ": " +
      std::strerror(errno) + ": expected a folder with room (TMPDIR)");
}

}  // namespace

SpoolFile::~SpoolFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::uint64_t SpoolFile::Append(const void* data, std::size_t bytes) {
  if (descriptor_ < 0) {
    std::string path = TemporaryFilesFolder() + "/splitfusion-XXXXXX";
    descriptor_ = mkstemp(path.data());
    if (descriptor_ < 0) FailSpooling("made");
    unlink(path.c_str());
  }
  const std::uint64_t offset = end_;
  Write(offset, data, bytes);
  end_ += bytes;
  return offset;
}

void SpoolFile::Write(std::uint64_t offset, const void* data,
                      std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written =
        pwrite(descriptor_, next, bytes, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) FailSpooling("written");
    next += written;
    offset += static_cast<std::uint64_t>(written);
    bytes -= static_cast<std::size_t>(written);
  }
}

void SpoolFile::Read(std::uint64_t offset, void* data,
                     std::size_t bytes) const {
  char* next = static_cast<char*>(data);
  while (bytes > 0) {
    const ssize_t read =
        pread(descriptor_, next, bytes, static_cast<off_t>(offset));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) FailSpooling("read");
    next += read;
    offset += static_cast<std::uint64_t>(read);
    bytes -= static_cast<std::size_t>(read);
  }
}

}  // namespace splitfusion
