#ifndef SPLITFUSION_LIB_BASE_ARCHIVE_FILE_H_
#define SPLITFUSION_LIB_BASE_ARCHIVE_FILE_H_

#include <cstdint>
#include <functional>
#include <string>

#include "splitfusion/lib/base/archive_stream.h"

namespace splitfusion {

/// Writes an archive through a temporary name: 8 bytes "SFSTATE1", uint32
/// `version` of what `write` writes, all that, and the XXH3-64 checksum (8
/// bytes) of everything before it. A failure leaves an old file as it was.
///
/// @throw InputError if the file cannot be written, and what `write` throws.
void WriteArchiveFile(const std::string& path, std::uint32_t version,
                      const std::function<void(ArchiveWriter*)>& write);

/// Reads what WriteArchiveFile wrote. `read` is called only if the file is
/// whole and of this version, and has to read all of it.
///
/// @throw InputError that names the file, and what `read` throws.
void ReadArchiveFile(const std::string& path, std::uint32_t version,
                     const std::function<void(ArchiveReader*)>& read);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_ARCHIVE_FILE_H_
