#include "splitfusion/lib/deformation/motion_history.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

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

/// Takes values off the content of a file, one after the other.
class ByteReader {
 public:
  /// Those from `begin` to before `end`; `path`: of the file, for messages.
  ByteReader(const std::string& path, const std::string& bytes,
             std::size_t begin, std::size_t end)
      : path_(path), next_(bytes.data() + begin), end_(bytes.data() + end) {}

  /// @throw InputError if there are not so many values of this kind.
  template <typename T>
  void Expect(std::uint64_t values) const {
    if (values <= left() / sizeof(T)) return;
    throw InputError(path_ + ": ends " +
                     std::to_string(values * sizeof(T) - left()) +
                     " bytes early: expected a complete file");
  }

  template <typename T>
  T Read() {
    Expect<T>(1);
    T value;
    std::memcpy(&value, next_, sizeof(T));
    next_ += sizeof(T);
    return value;
  }

  std::size_t left() const { return end_ - next_; }

 private:
  const std::string& path_;
  const char* next_;
  const char* end_;
};

/// Of all nodes, where a frame does not say which.
std::vector<NodeRange> RangesOf(const FrameMotions& frame, int nodes) {
  return frame.ranges.empty() ? std::vector<NodeRange>{{0, nodes}}
                              : frame.ranges;
}

std::string BytesOf(const MotionHistory& history, int nodes) {
  std::string bytes(kMagic, kMagicBytes);
  Append(static_cast<std::uint32_t>(history.frames.size()), &bytes);
  Append(static_cast<std::uint32_t>(nodes), &bytes);
  for (const FrameMotions& frame : history.frames) {
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
    for (const NodeMotion& motion : frame.motions) {
      Append(Store(motion), &bytes);
    }
    for (std::size_t i = 0; i < count; ++i) {
      Append(static_cast<char>(i < frame.seen.size() && frame.seen[i] != 0),
             &bytes);
    }
  }
  Append(Checksum64(bytes.data(), bytes.size()), &bytes);
  return bytes;
}

std::string ReadMotionBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return std::move(bytes).str();
}

/// @throw InputError if there is none.
const Version& ExpectVersion(const std::string& path,
                             const std::string& bytes) {
  const Version* version = VersionOf(bytes);
  if (version != nullptr) return *version;
  throw InputError(path + ": begins with " + Quoted(bytes.substr(0, 8)) +
                   ": expected '" + kMagic +
                   "' or an older version of it; a newer one needs its "
                   "programs");
}

/// Where the checksum begins, or the file ends.
///
/// @throw InputError unless the checksum is that of all bytes before it.
std::size_t EndOfFrames(const std::string& path, const Version& version,
                        const std::string& bytes) {
  if (!version.has_checksum) return bytes.size();
  if (bytes.size() >= kMagicBytes + sizeof(std::uint64_t)) {
    const std::size_t end = bytes.size() - sizeof(std::uint64_t);
    if (ByteReader(path, bytes, end, bytes.size()).Read<std::uint64_t>() ==
        Checksum64(bytes.data(), end)) {
      return end;
    }
  }
  throw InputError(path +
                   ": is truncated or damaged: its checksum does not "
                   "fit its " +
                   std::to_string(bytes.size()) + " bytes");
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
      (!before.frames.empty() && before.frames.back().frame >= frame.frame)) {
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
  for (std::size_t i = 0; version.has_seen && i < count; ++i) {
    frame.seen.push_back(reader->Read<char>());
  }
  return frame;
}

}  // namespace

int FrameMotions::IndexOf(int node) const {
  if (ranges.empty()) {
    return node < static_cast<int>(motions.size()) ? node : -1;
  }
  int before = 0;
  for (const NodeRange& range : ranges) {
    if (node < range.begin) return -1;
    if (node < range.end) return before + node - range.begin;
    before += range.end - range.begin;
  }
  return -1;
}

void FrameMotions::SpreadTo(std::vector<NodeMotion>* all) const {
  auto from = motions.begin();
  const std::vector<NodeRange> of_all = {{0, static_cast<int>(motions.size())}};
  for (const NodeRange& range : ranges.empty() ? of_all : ranges) {
    const auto count = range.end - range.begin;
    std::copy_n(from, count, all->begin() + range.begin);
    from += count;
  }
}

const FrameMotions* MotionHistory::Find(int frame) const {
  const auto found = std::lower_bound(
      frames.begin(), frames.end(), frame,
      [](const FrameMotions& item, int index) { return item.frame < index; });
  return found != frames.end() && found->frame == frame ? &*found : nullptr;
}

std::vector<NodeMotion> MotionsOfAll(const MotionHistory& history,
                                     const DeformationGraph& graph, int frame) {
  std::vector<NodeMotion> all(graph.size());
  history.Find(frame)->SpreadTo(&all);
  for (std::size_t k = 0; k < graph.parts.size(); ++k) {
    const ModelPart& part = graph.parts[k];
    const int nearest = std::clamp(frame, part.first_frame, part.end_frame - 1);
    const FrameMotions* own =
        nearest == frame ? nullptr : history.Find(nearest);
    const int from = own == nullptr ? -1 : own->IndexOf(part.node);
    if (from < 0) continue;
    const int end =
        k + 1 < graph.parts.size() ? graph.parts[k + 1].node : graph.size();
    std::copy_n(own->motions.begin() + from, end - part.node,
                all.begin() + part.node);
  }
  return all;
}

void WriteMotions(const std::string& path, const MotionHistory& history,
                  int nodes) {
  const std::string bytes = BytesOf(history, nodes);
  WriteFileAtomically(path, [&](std::ostream& out) { out << bytes; });
}

MotionHistory ReadMotions(const std::string& path, int* nodes) {
  const std::string bytes = ReadMotionBytes(path);
  const Version& version = ExpectVersion(path, bytes);
  ByteReader reader(path, bytes, kMagicBytes,
                    EndOfFrames(path, version, bytes));
  const auto frames = reader.Read<std::uint32_t>();
  const auto count = reader.Read<std::uint32_t>();
  MotionHistory history;
  for (std::uint32_t i = 0; i < frames; ++i) {
    FrameMotions frame = ReadFrame(path, version, count, &reader);
    CheckFrame(path, frame, history);
    history.frames.push_back(std::move(frame));
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
