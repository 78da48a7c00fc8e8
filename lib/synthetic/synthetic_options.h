#ifndef SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_OPTIONS_H_
#define SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_OPTIONS_H_

#include <cstdint>
#include <string>

#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

/// What a synthetic sequence shows.
enum class SyntheticSceneKind {
  kRoomPerson,  ///< Room, walking person and a soft toy on a table.
  kRoom,        ///< The room alone: nothing but the camera moves.
  kPerson,      ///< The person alone, seen from nearer; nothing around it.
  kSoftObject,  ///< The soft toy alone, near; nothing around it.
};

/// Word for options and reports: "room_person", "room", "person",
/// "soft_object".
std::string ToString(SyntheticSceneKind kind);

/// Inverse of ToString.
///
/// @throw InputError on an unknown word; lists the known ones.
SyntheticSceneKind ParseSyntheticSceneKind(const std::string& word);

/// Options of a synthetic sequence. The same options give the same bytes.
struct SyntheticOptions {
  SyntheticSceneKind scene = SyntheticSceneKind::kRoomPerson;  ///< Content.
  int frames = 90;           ///< Number of frames.
  int width = 640;           ///< Image width, pixels; 64 to 1920.
  int height = 480;          ///< Image height, pixels; 48 to 1440.
  std::uint32_t seed = 1;    ///< Of textures, camera shake, noise and masks.
  bool noise = true;         ///< Kinect-like depth noise and colour noise.
  bool exact_masks = false;  ///< Detections are the exact labels, none missed.
  double frame_rate = 30;    ///< Frames a second.
  /// Scale of the camera's path: 1 is a hand-held sweep of about 0.2 m/s, 0 a
  /// camera on a tripod.
  double camera_motion = 1;
  /// Speed of person and toy: 1 is a calm walk of 0.5 m/s, 0 stands still.
  double subject_speed = 1;
  int track_points = 500;  ///< Tracked surface points per non-rigid instance.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// Intrinsics of the sequence: those of a Kinect (535.4, 539.2, 320.1, 247.6
/// at 640x480), scaled to the image size.
PinholeCamera SyntheticCamera(const SyntheticOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SYNTHETIC_OPTIONS_H_
