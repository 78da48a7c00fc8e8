#ifndef SPLITFUSION_LIB_BASE_SPOOL_FILE_H_
#define SPLITFUSION_LIB_BASE_SPOOL_FILE_H_

#include <cstddef>
#include <cstdint>

namespace splitfusion {

/// A file without a name for what would fill the memory: in the folder of
/// temporary files (TMPDIR), made when it is first written, gone with its
/// object or the program.
class SpoolFile {
 public:
  SpoolFile() = default;
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  /// Writes bytes behind all others; returns where they begin.
  ///
  /// @throw TemporaryFileError if it cannot be made, or they cannot be written,
  ///     as on a full disk.
  std::uint64_t Append(const void* data, std::size_t bytes);

  /// Writes bytes in place of others.
  ///
  /// @throw TemporaryFileError as Append().
  void Write(std::uint64_t offset, const void* data, std::size_t bytes);

  /// Reads bytes that were written; from several threads at once, too.
  ///
  /// @throw TemporaryFileError if they cannot be read.
  void Read(std::uint64_t offset, void* data, std::size_t bytes) const;

 private:
  int descriptor_ = -1;  // None yet.
  std::uint64_t end_ = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_SPOOL_FILE_H_
