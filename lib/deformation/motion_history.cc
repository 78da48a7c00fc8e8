#include "splitfusion/lib/deformation/motion_history.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"

namespace splitfusion {
namespace {

/// Eight bytes at the beginning; the last two are the version.
constexpr char kMagic[] = "SFMOTN03";
constexpr std::size_t kMagicBytes = 8;  // Format.
/// R row by row, then t.
using StoredMotion = std::array<float, 12>;

StoredMotion Store(const NodeMotion& motion) {
  StoredMotion stored;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      stored[3 * row + column] =
          static_cast<float>(motion.rotation(row, column));
    }
    stored[9 + row] = static_cast<float>(motion.translation[row]);
  }
  return stored;
}

NodeMotion Restore(const StoredMotion& stored) {
  NodeMotion motion;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      motion.rotation(row, column) = stored[3 * row + column];
    }
    motion.translation[row] = stored[9 + row];
  }
  return motion;
}

/// What a version of the file has.
struct Version {
  const char* magic;
  bool has_seen;      // Which nodes were.
  bool has_checksum;  // At the end.

  std::uintmax_t BytesOfFrame(std::uintmax_t nodes) const {
    return 8 + nodes * (sizeof(StoredMotion) + (has_seen ? 1 : 0));
  }
};

constexpr std::array<Version, 3> kVersions = {{{kMagic, true, true},
                                               {"SFMOTN02", false, true},
                                               {"SFMOTN01", false, false}}};

/// That of a file that begins with `head`; null: of none.
const Version* VersionOf(const std::string& head) {
  for (const Version& version : kVersions) {
    if (head.compare(0, kMagicBytes, version.magic) == 0) return &version;
  }
  return nullptr;
}

template <typename T>
void Append(const T& value, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(&value), sizeof(T));
}

/// Takes values off the content of a file, one after the other.
class ByteReader {
 public:
  ByteReader(const std::string& bytes, std::size_t begin)
      : next_(bytes.data() + begin) {}

  template <typename T>
  T Read() {
    T value;
    std::memcpy(&value, next_, sizeof(T));
    next_ += sizeof(T);
    return value;
  }

 private:
  const char* next_;
};

std::string BytesOf(const MotionHistory& history) {
  const std::size_t nodes =
      history.frames.empty() ? 0 : history.frames.front().motions.size();
  std::string bytes(kMagic, kMagicBytes);
  Append(static_cast<std::uint32_t>(history.frames.size()), &bytes);
  Append(static_cast<std::uint32_t>(nodes), &bytes);
  for (const FrameMotions& frame : history.frames) {
    assert(frame.motions.size() == nodes);
    Append(static_cast<std::int32_t>(frame.frame), &bytes);
    Append(static_cast<std::int32_t>(frame.tracked ? 1 : 0), &bytes);
    for (const NodeMotion& motion : frame.motions) {
      Append(Store(motion), &bytes);
    }
    for (std::size_t i = 0; i < nodes; ++i) {
      Append(static_cast<char>(frame.Saw(static_cast<int>(i))), &bytes);
    }
  }
  Append(Checksum64(bytes.data(), bytes.size()), &bytes);
  return bytes;
}

/// Bytes of a file of motions; a file that cannot be one is not read.
///
/// @throw InputError if the size is not the one that its head states.
std::string ReadMotionBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::string head(kMagicBytes + 8, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  const Version* version = VersionOf(head);
  if (version == nullptr) {
    throw InputError(path + ": begins with " + Quoted(head.substr(0, 8)) +
                     ": expected '" + kMagic +
                     "' or an older version of it; a newer one needs its "
                     "programs");
  }
  ByteReader reader(head, kMagicBytes);
  const auto frames = reader.Read<std::uint32_t>();
  const auto nodes = reader.Read<std::uint32_t>();
  const std::uintmax_t expected =
      head.size() + frames * version->BytesOfFrame(nodes) +
      (version->has_checksum ? sizeof(std::uint64_t) : 0);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size != expected) {
    throw InputError(path + ": " + std::to_string(size) + " bytes: expected " +
                     std::to_string(expected) + " for " +
                     std::to_string(frames) + " frames of " +
                     std::to_string(nodes) + " nodes");
  }
  std::string bytes(expected, '\0');
  stream.seekg(0);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw InputError(path + ": cannot be read to its end");
  return bytes;
}

/// @throw InputError unless the last eight bytes are the checksum of all before
///     them, or there is none.
void CheckSum(const std::string& path, const std::string& bytes) {
  if (!VersionOf(bytes)->has_checksum) return;
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  if (ByteReader(bytes, end).Read<std::uint64_t>() ==
      Checksum64(bytes.data(), end)) {
    return;
  }
  throw InputError(path +
                   ": is damaged: its checksum does not fit its content");
}

/// Whether a motion can be one: finite, and its matrix a rotation as far as
/// floats keep it.
bool IsRigid(const NodeMotion& motion) {
  constexpr double kTolerance = 1e-3;  // Maths.
  const Eigen::Matrix3d& r = motion.rotation;
  return motion.translation.allFinite() && r.allFinite() &&
         (r.transpose() * r).isIdentity(kTolerance) && r.determinant() > 0;
}

void CheckFrame(const std::string& path, const FrameMotions& frame,
                const MotionHistory& before) {
  const std::string place = path + ": frame " + std::to_string(frame.frame);
  if (frame.frame < 0 ||
      (!before.frames.empty() && before.frames.back().frame >= frame.frame)) {
    throw InputError(place + ": expected frames in ascending order, from 0");
  }
  for (std::size_t i = 0; i < frame.motions.size(); ++i) {
    if (IsRigid(frame.motions[i])) continue;
    throw InputError(place + ", node " + std::to_string(i) +
                     ": its motion is no rotation and translation: the file "
                     "is damaged");
  }
}

FrameMotions ReadFrame(std::uint32_t nodes, bool has_seen, ByteReader* reader) {
  FrameMotions frame;
  frame.frame = reader->Read<std::int32_t>();
  frame.tracked = reader->Read<std::int32_t>() != 0;
  frame.motions.reserve(nodes);
  for (std::uint32_t i = 0; i < nodes; ++i) {
    frame.motions.push_back(Restore(reader->Read<StoredMotion>()));
  }
  for (std::uint32_t i = 0; has_seen && i < nodes; ++i) {
    frame.seen.push_back(reader->Read<char>());
  }
  return frame;
}

}  // namespace

const FrameMotions* MotionHistory::Find(int frame) const {
  const auto found = std::lower_bound(
      frames.begin(), frames.end(), frame,
      [](const FrameMotions& item, int index) { return item.frame < index; });
  return found != frames.end() && found->frame == frame ? &*found : nullptr;
}

void WriteMotions(const std::string& path, const MotionHistory& history) {
  const std::string bytes = BytesOf(history);
  WriteFileAtomically(path, [&](std::ostream& out) { out << bytes; });
}

MotionHistory ReadMotions(const std::string& path) {
  const std::string bytes = ReadMotionBytes(path);
  CheckSum(path, bytes);
  ByteReader reader(bytes, kMagicBytes);
  const auto frames = reader.Read<std::uint32_t>();
  const auto nodes = reader.Read<std::uint32_t>();
  MotionHistory history;
  for (std::uint32_t i = 0; i < frames; ++i) {
    FrameMotions frame = ReadFrame(nodes, VersionOf(bytes)->has_seen, &reader);
    CheckFrame(path, frame, history);
    history.frames.push_back(std::move(frame));
  }
  return history;
}

}  // namespace splitfusion
