#include "splitfusion/lib/deformation/motion_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"

namespace splitfusion {
namespace {

/// Eight bytes at the beginning; the last two are the version.
constexpr char kMagic[] = "SFMOTN04";
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
  bool has_ranges;    // Of nodes that have motions in a frame; else all have.
  bool has_seen;      // Which nodes were.
  bool has_checksum;  // At the end.
};

constexpr std::array<Version, 4> kVersions = {
    {{kMagic, true, true, true},
     {"SFMOTN03", false, true, true},
     {"SFMOTN02", false, false, true},
     {"SFMOTN01", false, false, false}}};

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

/// Takes values off a file, one after the other.
class ByteReader {
 public:
  /// Those from `begin` to before `end`; `path`: of the file, for messages.
  ///
  /// @throw InputError if they cannot be read.
  ByteReader(const std::string& path, std::ifstream* stream,
             std::uint64_t begin, std::uint64_t end)
      : path_(path), stream_(*stream), left_(end - begin) {
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(begin));
  }

  /// @throw InputError if there are not so many values of this kind.
  template <typename T>
  void Expect(std::uint64_t values) const {
    if (values <= left_ / sizeof(T)) return;
    throw InputError(path_ + ": ends " +
                     std::to_string(values * sizeof(T) - left_) +
                     " bytes early: expected a complete file");
  }

  template <typename T>
  T Read() {
    Expect<T>(1);
    T value;
    ReadBytes(&value, sizeof(T));
    return value;
  }

  void ReadBytes(void* data, std::size_t bytes) {
    stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
    if (!stream_) throw InputError(path_ + ": cannot be read to its end");
    left_ -= bytes;
  }

  std::uint64_t left() const { return left_; }

 private:
  const std::string& path_;
  std::ifstream& stream_;
  std::uint64_t left_;
};

/// Of all nodes, where a frame does not say which.
std::vector<NodeRange> RangesOf(const FrameMotions& frame, int nodes) {
  return frame.ranges.empty() ? std::vector<NodeRange>{{0, nodes}}
                              : frame.ranges;
}

std::string BytesOf(const FrameMotions& frame, int nodes) {
  std::string bytes;
  const std::vector<NodeRange> ranges = RangesOf(frame, nodes);
  Append(static_cast<std::int32_t>(frame.frame), &bytes);
  Append(static_cast<std::int32_t>(frame.tracked ? 1 : 0), &bytes);
  Append(static_cast<std::uint32_t>(ranges.size()), &bytes);
  std::size_t count = 0;
  for (const NodeRange& range : ranges) {
    Append(static_cast<std::uint32_t>(range.begin), &bytes);
    Append(static_cast<std::uint32_t>(range.end), &bytes);
    count += range.end - range.begin;
  }
  assert(frame.motions.size() == count);
  for (const NodeMotion& motion : frame.motions) Append(Store(motion), &bytes);
  for (std::size_t i = 0; i < count; ++i) {
    Append(static_cast<char>(i < frame.seen.size() && frame.seen[i] != 0),
           &bytes);
  }
  return bytes;
}

/// @throw InputError if the file is of no version.
const Version& ExpectVersion(const std::string& path, std::ifstream* stream) {
  std::string head(kMagicBytes, '\0');
  stream->seekg(0);
  stream->read(head.data(), kMagicBytes);
  head.resize(static_cast<std::size_t>(stream->gcount()));
  const Version* version = VersionOf(head);
  if (version != nullptr) return *version;
  throw InputError(path + ": begins with " + Quoted(head) + ": expected '" +
                   kMagic +
                   "' or an older version of it; a newer one needs its "
                   "programs");
}

/// Of the first bytes of a file.
std::uint64_t ChecksumOf(const std::string& path, std::ifstream* stream,
                         std::uint64_t bytes) {
  ByteReader reader(path, stream, 0, bytes);
  std::vector<char> buffer(1 << 20);
  RunningChecksum64 checksum;
  while (reader.left() > 0) {
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(buffer.size(), reader.left()));
    reader.ReadBytes(buffer.data(), count);
    checksum.Add(buffer.data(), count);
  }
  return checksum.Value();
}

/// Where the checksum begins, or the file ends.
///
/// @throw InputError unless the checksum is that of all bytes before it.
std::uint64_t EndOfFrames(const std::string& path, const Version& version,
                          std::uint64_t size, std::ifstream* stream) {
  if (!version.has_checksum) return size;
  if (size >= kMagicBytes + sizeof(std::uint64_t)) {
    const std::uint64_t end = size - sizeof(std::uint64_t);
    const auto stored =
        ByteReader(path, stream, end, size).Read<std::uint64_t>();
    if (stored == ChecksumOf(path, stream, end)) return end;
  }
  throw InputError(path +
                   ": is truncated or damaged: its checksum does not "
                   "fit its " +
                   std::to_string(size) + " bytes");
}

/// Whether a motion can be one: finite, and its matrix a rotation as far as
/// floats keep it.
bool IsRigid(const NodeMotion& motion) {
  constexpr double kTolerance = 1e-3;  // Maths.
  const Eigen::Matrix3d& r = motion.rotation;
  return motion.translation.allFinite() && r.allFinite() &&
         (r.transpose() * r).isIdentity(kTolerance) && r.determinant() > 0;
}

/// The node of which motion `index` of a frame is.
int NodeOf(const FrameMotions& frame, int index) {
  for (const NodeRange& range : frame.ranges) {
    if (index < range.end - range.begin) return range.begin + index;
    index -= range.end - range.begin;
  }
  return index;
}

void CheckFrame(const std::string& path, const FrameMotions& frame,
                const MotionHistory& before) {
  const std::string place = path + ": frame " + std::to_string(frame.frame);
  if (frame.frame < 0 ||
      (!before.empty() && before.frame(before.size() - 1) >= frame.frame)) {
    throw InputError(place + ": expected frames in ascending order, from 0");
  }
  for (std::size_t i = 0; i < frame.motions.size(); ++i) {
    if (IsRigid(frame.motions[i])) continue;
    throw InputError(place + ", node " +
                     std::to_string(NodeOf(frame, static_cast<int>(i))) +
                     ": its motion is no rotation and translation: the file "
                     "is damaged");
  }
}

/// The ranges of a frame, none if they are all nodes.
std::vector<NodeRange> ReadRanges(const std::string& path, std::uint32_t nodes,
                                  ByteReader* reader) {
  const auto count = reader->Read<std::uint32_t>();
  reader->Expect<std::uint64_t>(count);
  if (count == 0) throw InputError(path + ": a frame of no nodes");
  std::vector<NodeRange> ranges;
  std::uint32_t last = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto begin = reader->Read<std::uint32_t>();
    const auto end = reader->Read<std::uint32_t>();
    if (begin < last || end < begin || end > nodes) {
      throw InputError(path + ": nodes " + std::to_string(begin) + " to " +
                       std::to_string(end) + ": expected ascending ones of " +
                       std::to_string(nodes));
    }
    last = end;
    ranges.push_back({static_cast<int>(begin), static_cast<int>(end)});
  }
  const bool are_all = count == 1 && ranges[0].begin == 0 && last == nodes;
  return are_all ? std::vector<NodeRange>() : ranges;
}

FrameMotions ReadFrame(const std::string& path, const Version& version,
                       std::uint32_t nodes, ByteReader* reader) {
  FrameMotions frame;
  frame.frame = reader->Read<std::int32_t>();
  frame.tracked = reader->Read<std::int32_t>() != 0;
  if (version.has_ranges) frame.ranges = ReadRanges(path, nodes, reader);
  std::size_t count = frame.ranges.empty() ? nodes : 0;
  for (const NodeRange& range : frame.ranges) count += range.end - range.begin;
  reader->Expect<StoredMotion>(count);
  frame.motions.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    frame.motions.push_back(Restore(reader->Read<StoredMotion>()));
  }
  if (version.has_seen) {
    reader->Expect<char>(count);
    frame.seen.resize(count);
    reader->ReadBytes(frame.seen.data(), count);
  }
  return frame;
}

}  // namespace

void WriteMotions(const std::string& path, const MotionHistory& history,
                  int nodes) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    RunningChecksum64 checksum;
    const auto write = [&](const std::string& bytes) {
      checksum.Add(bytes.data(), bytes.size());
      out << bytes;
    };
    std::string head(kMagic, kMagicBytes);
    Append(static_cast<std::uint32_t>(history.size()), &head);
    Append(static_cast<std::uint32_t>(nodes), &head);
    write(head);
    for (const FrameMotions& frame : history) write(BytesOf(frame, nodes));
    std::string tail;
    Append(checksum.Value(), &tail);
    out << tail;
  });
}

MotionHistory ReadMotions(const std::string& path, int* nodes) {
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) throw InputError(path + ": cannot be opened");
  const auto size = static_cast<std::uint64_t>(stream.tellg());
  const Version& version = ExpectVersion(path, &stream);
  const std::uint64_t end = EndOfFrames(path, version, size, &stream);
  ByteReader reader(path, &stream, kMagicBytes, end);
  const auto frames = reader.Read<std::uint32_t>();
  const auto count = reader.Read<std::uint32_t>();
  MotionHistory history;
  for (std::uint32_t i = 0; i < frames; ++i) {
    FrameMotions frame = ReadFrame(path, version, count, &reader);
    CheckFrame(path, frame, history);
    history.Append(std::move(frame));
  }
  if (reader.left() > 0) {
    throw InputError(path + ": " + std::to_string(reader.left()) +
                     " bytes too many for " + std::to_string(frames) +
                     " frames of " + std::to_string(count) + " nodes");
  }
  if (count > std::numeric_limits<std::int32_t>::max()) {
    throw InputError(path + ": " + std::to_string(count) +
                     " nodes: expected fewer: the file is damaged");
  }
  if (nodes != nullptr) *nodes = static_cast<int>(count);
  return history;
}

}  // namespace splitfusion
