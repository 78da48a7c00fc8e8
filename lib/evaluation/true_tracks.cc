#include "splitfusion/lib/evaluation/true_tracks.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr std::uint32_t kMagic = 0x4b525431;

/// Head of a record; instance, triangle, two weights.
struct StoredPoint {
  std::int32_t instance;
  std::int32_t triangle;
  float b1;
  float b2;
};

template <typename T>
void Copy(const std::vector<char>& bytes, std::size_t* offset, std::size_t n,
          T* values) {
  std::memcpy(values, bytes.data() + *offset, n * sizeof(T));
  *offset += n * sizeof(T);
}

}  // namespace

TrueTracks TrueTracks::Read(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  const std::vector<char> bytes(std::istreambuf_iterator<char>(stream), {});
  std::array<std::uint32_t, 4> head{};
  std::size_t offset = 0;
  if (bytes.size() >= sizeof(head)) Copy(bytes, &offset, 4, head.data());
  if (head[0] != kMagic || head[1] != 1) {
    throw InputError(path +
                     ": expected a track file (magic 0x4b525431, "
                     "version 1)");
  }
  const std::size_t points = head[3];
  const std::size_t entries = std::size_t{head[2]} * points;
  const std::size_t expected =
      sizeof(head) + points * sizeof(StoredPoint) + entries * 13;
  if (bytes.size() != expected) {
    throw InputError(path + ": " + std::to_string(bytes.size()) +
                     " bytes: expected " + std::to_string(expected));
  }
  TrueTracks tracks;
  tracks.frames_ = static_cast<int>(head[2]);
  tracks.points_ = static_cast<int>(points);
  std::vector<StoredPoint> stored(points);
  Copy(bytes, &offset, points, stored.data());
  for (const StoredPoint& p : stored) tracks.instances_.push_back(p.instance);
  std::vector<float> coordinates(3 * entries);
  Copy(bytes, &offset, coordinates.size(), coordinates.data());
  for (std::size_t i = 0; i < entries; ++i) {
    tracks.positions_.emplace_back(coordinates[3 * i], coordinates[3 * i + 1],
                                   coordinates[3 * i + 2]);
  }
  tracks.visible_.resize(entries);
  Copy(bytes, &offset, entries, tracks.visible_.data());
  return tracks;
}

int TrueTracks::VisibleCount(int frame) const {
  int count = 0;
  for (int i = 0; i < points_; ++i) count += Visible(frame, i) ? 1 : 0;
  return count;
}

std::vector<TrackPoint> TrueTracks::Queries(
    int frame, const Rigid3d& world_from_camera) const {
  const Rigid3d camera_from_world = world_from_camera.inverse();
  std::vector<TrackPoint> queries;
  for (int i = 0; i < points_; ++i) {
    if (Visible(frame, i)) {
      queries.push_back({i, frame, camera_from_world * Position(frame, i)});
    }
  }
  return queries;
}

}  // namespace splitfusion
