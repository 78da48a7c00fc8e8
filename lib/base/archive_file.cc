#include "splitfusion/lib/base/archive_file.h"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <streambuf>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

using Magic = std::array<char, 8>;
constexpr Magic kMagic = {'S', 'F', 'S', 'T', 'A', 'T', 'E', '1'};

constexpr std::uint64_t kHeaderBytes = sizeof(Magic) + sizeof(std::uint32_t);
using Checksum = XXH64_hash_t;

/// XXH3-64 of bytes given piece by piece.
class RunningChecksum {
 public:
  RunningChecksum() : state_(XXH3_createState(), XXH3_freeState) {
    XXH3_64bits_reset(state_.get());
  }
  void Add(const char* data, std::size_t bytes) {
    XXH3_64bits_update(state_.get(), data, bytes);
  }
  Checksum Value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

/// Passes on what is written through it and computes the checksum.
class ChecksumBuffer : public std::streambuf {
 public:
  explicit ChecksumBuffer(std::streambuf* to) : to_(to) {}
  Checksum Value() const { return checksum_.Value(); }

 protected:
  std::streamsize xsputn(const char* data, std::streamsize bytes) override {
    checksum_.Add(data, static_cast<std::size_t>(bytes));
    return to_->sputn(data, bytes);
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
  }

 private:
  std::streambuf* to_;
  RunningChecksum checksum_;
};

template <typename T>
void WriteBytes(const T& value, std::ostream* out) {
  out->write(reinterpret_cast<const char*>(&value), sizeof(value));
}

template <typename T>
T ReadBytes(std::istream* in) {
  T value{};
  in->read(reinterpret_cast<char*>(&value), sizeof(value));
  return value;
}

/// Checksum of the next bytes of a stream; stops where they end early.
Checksum ChecksumOf(std::istream* in, std::uint64_t bytes) {
  std::vector<char> piece(std::size_t{1} << 20);
  RunningChecksum checksum;
  while (bytes > 0 && *in) {
    const auto size = std::min<std::uint64_t>(bytes, piece.size());
    in->read(piece.data(), static_cast<std::streamsize>(size));
    checksum.Add(piece.data(), static_cast<std::size_t>(in->gcount()));
    bytes -= size;
  }
  return checksum.Value();
}

std::uint64_t SizeOf(std::istream* in) {
  in->seekg(0, std::ios::end);
  const auto size = static_cast<std::uint64_t>(in->tellg());
  in->seekg(0);
  return size;
}

/// Looks at all that is not the content; gives the content's bytes.
std::uint64_t CheckFile(const std::string& path, std::uint32_t version,
                        std::istream* in) {
  const std::uint64_t size = SizeOf(in);
  if (size < kHeaderBytes + sizeof(Checksum) ||
      ReadBytes<Magic>(in) != kMagic) {
    throw InputError(path + ": expected a file that begins with 'SFSTATE1'");
  }
  const auto found = ReadBytes<std::uint32_t>(in);
  if (found != version) {
    throw InputError(path + ": version " + std::to_string(found) +
                     ": expected version " + std::to_string(version));
  }
  in->seekg(0);
  const std::uint64_t whole = size - sizeof(Checksum);
  const Checksum checksum = ChecksumOf(in, whole);
  if (ReadBytes<Checksum>(in) != checksum || !*in) {
    throw InputError(path +
                     ": damaged: its content does not have its checksum");
  }
  in->seekg(static_cast<std::streamoff>(kHeaderBytes));
  return whole - kHeaderBytes;
}

}  // namespace

void WriteArchiveFile(const std::string& path, std::uint32_t version,
                      const std::function<void(ArchiveWriter*)>& write) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    ChecksumBuffer buffer(out.rdbuf());
    std::ostream checked(&buffer);
    WriteBytes(kMagic, &checked);
    WriteBytes(version, &checked);
    ArchiveWriter archive(&checked);
    write(&archive);
    archive.Flush();
    WriteBytes(buffer.Value(), &out);
    if (!checked) out.setstate(std::ios::failbit);
  });
}

void ReadArchiveFile(const std::string& path, std::uint32_t version,
                     const std::function<void(ArchiveReader*)>& read) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(path + ": cannot be opened");
  const std::uint64_t bytes = CheckFile(path, version, &in);
  ArchiveReader archive(&in, bytes, path);
  read(&archive);
  if (archive.left() > 0) {
    archive.Fail("ends " + std::to_string(archive.left()) +
                 " bytes before the file");
  }
}

}  // namespace splitfusion
