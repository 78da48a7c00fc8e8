#include "splitfusion/lib/energy/terms_library_file.h"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace splitfusion {
namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);

/// Reads one value at a place of a file; false if the file ends before.
template <typename T>
bool ReadAt(std::uint64_t place, std::ifstream* file, T* value) {
  file->seekg(static_cast<std::streamoff>(place));
  return bool(file->read(reinterpret_cast<char*>(value), sizeof *value));
}

std::string CutOff(std::uint64_t size, std::uint64_t needed) {
  return "is cut off: " + std::to_string(size) + " bytes, expected " +
         std::to_string(needed) + " or more";
}

}  // namespace

std::string WhyCutOff(const std::string& path) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  Header header;
  if (error || !ReadAt(0, &file, &header) ||
      std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0 ||
      header.e_phentsize != sizeof(Segment)) {
    return "";
  }
  std::uint64_t end =
      header.e_shoff + std::uint64_t{header.e_shnum} * header.e_shentsize;
  for (int i = 0; i < header.e_phnum; ++i) {
    Segment segment;
    const std::uint64_t place = header.e_phoff + i * sizeof segment;
    if (!ReadAt(place, &file, &segment)) {
      return CutOff(size, place + sizeof segment);
    }
    end = std::max<std::uint64_t>(end, segment.p_offset + segment.p_filesz);
  }
  return end > size ? CutOff(size, end) : "";
}

std::string SymbolText(const void* symbol) {
  Dl_info info;
  void* entry = nullptr;
  if (dladdr1(symbol, &info, &entry, RTLD_DL_SYMENT) == 0 || entry == nullptr) {
    return "";
  }
  const auto* text = static_cast<const char*>(symbol);
  return {text, strnlen(text, static_cast<const ElfW(Sym)*>(entry)->st_size)};
}

}  // namespace splitfusion
