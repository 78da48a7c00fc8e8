#include "splitfusion/lib/synthetic/synthetic_options.h"

#include <algorithm>
#include <array>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// By SyntheticSceneKind.
constexpr std::array<const char*, 4> kSceneNames = {"room_person", "room",
                                                    "person", "soft_object"};

}  // namespace

std::string ToString(SyntheticSceneKind kind) {
  return kSceneNames[static_cast<std::size_t>(kind)];
}

SyntheticSceneKind ParseSyntheticSceneKind(const std::string& word) {
  const auto found = std::find(kSceneNames.begin(), kSceneNames.end(), word);
  CheckOption(found != kSceneNames.end(), "scene", word,
              "one of room_person, room, person, soft_object");
  return static_cast<SyntheticSceneKind>(found - kSceneNames.begin());
}

void SyntheticOptions::Check() const {
  CheckOption(frames >= 1 && frames <= 100000, "frames", frames, "1 to 100000");
  CheckOption(width >= 64 && width <= 1920, "width", width,
              "64 to 1920 pixels");
  CheckOption(height >= 48 && height <= 1440, "height", height,
              "48 to 1440 pixels");
  CheckOption(frame_rate >= 1 && frame_rate <= 240, "frame_rate", frame_rate,
              "1 to 240 frames a second");
  CheckOption(camera_motion >= 0 && camera_motion <= 3, "camera_motion",
              camera_motion, "0 to 3");
  CheckOption(subject_speed >= 0 && subject_speed <= 4, "subject_speed",
              subject_speed, "0 to 4");
  CheckOption(track_points >= 0 && track_points <= 100000, "track_points",
              track_points, "0 to 100000");
}

PinholeCamera SyntheticCamera(const SyntheticOptions& options) {
  const double sx = options.width / 640.0;
  const double sy = options.height / 480.0;
  PinholeCamera camera;
  camera.width = options.width;
  camera.height = options.height;
  camera.fx = 535.4 * sx;
  camera.fy = 539.2 * sy;
  // Pixel centres are at integers: the image's left edge is at -0.5.
  camera.cx = (320.1 + 0.5) * sx - 0.5;
  camera.cy = (247.6 + 0.5) * sy - 0.5;
  return camera;
}

}  // namespace splitfusion
