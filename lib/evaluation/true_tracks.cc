#include "splitfusion/lib/evaluation/true_tracks.h"

#include <filesystem>
#include <fstream>
#include <system_error>

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
void ReadValues(std::istream* in, std::vector<T>* values) {
  in->read(reinterpret_cast<char*>(values->data()),
           static_cast<std::streamsize>(values->size() * sizeof(T)));
}

}  // namespace

TrueTracks TrueTracks::Read(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  std::vector<std::uint32_t> head(4);
  ReadValues(&stream, &head);
  if (!stream || head[0] != kMagic || head[1] != 1) {
    throw InputError(path +
                     ": expected a track file (magic 0x4b525431, "
                     "version 1)");
  }
  const std::size_t points = head[3];
  const std::size_t entries = std::size_t{head[2]} * points;
  const std::size_t expected = sizeof(head[0]) * head.size() +
                               points * sizeof(StoredPoint) +
                               entries * (sizeof(Eigen::Vector3f) + 1);
  std::error_code none;
  const std::uintmax_t bytes = std::filesystem::file_size(path, none);
  if (none || bytes != expected) {
    throw InputError(path + ": " +
                     (none ? "no file" : std::to_string(bytes) + " bytes") +
                     ": expected " + std::to_string(expected));
  }
  TrueTracks tracks;
  tracks.frames_ = static_cast<int>(head[2]);
  tracks.points_ = static_cast<int>(points);
  std::vector<StoredPoint> stored(points);
  ReadValues(&stream, &stored);
  for (const StoredPoint& p : stored) tracks.instances_.push_back(p.instance);
  tracks.positions_.resize(entries);
  ReadValues(&stream, &tracks.positions_);
  tracks.visible_.resize(entries);
  ReadValues(&stream, &tracks.visible_);
  if (!stream) throw InputError(path + ": ends while it is read");
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
