#include "camera_flags.h"

#include <gflags/gflags.h>

#include <optional>
#include <sstream>
#include <string>

#include "sequence_flags.h"
#include "splitfusion/lib/base/error.h"

DEFINE_string(intrinsics, "", "fx,fy,cx,cy,width,height; else from a file.");
DEFINE_double(depth_scale, 0, "Depth units in a metre; 0 = from a file.");
DEFINE_string(color_camera, "auto",
              "Camera of unregistered colour: FILE, auto, none.");
DEFINE_string(rolling_shutter, "auto",
              "Seconds from the first row to the last; or auto.");
DEFINE_bool(skip_bad_frames, false,
            "Leave out frames whose images are missing or broken.");

namespace splitfusion {
namespace {

PinholeCamera ParseIntrinsics(const std::string& text) {
  std::stringstream stream(text);
  PinholeCamera camera;
  char comma[5] = {};
  if (!(stream >> camera.fx >> comma[0] >> camera.fy >> comma[1] >> camera.cx >>
        comma[2] >> camera.cy >> comma[3] >> camera.width >> comma[4] >>
        camera.height) ||
      std::string(comma, 5) != ",,,,," || !(stream >> std::ws).eof()) {
    throw InputError("--intrinsics=" + text +
                     ": expected fx,fy,cx,cy,width,height");
  }
  try {
    camera.Check();
  } catch (const InputError& error) {
    throw InputError("--intrinsics=" + text + ": " + error.what());
  }
  return camera;
}

/// Seconds; none for "auto".
std::optional<double> ParseRollingShutter(const std::string& text) {
  if (text == "auto") return std::nullopt;
  std::stringstream stream(text);
  double seconds = 0;
  if (!(stream >> seconds) || !(stream >> std::ws).eof()) {
    throw InputError("--rolling_shutter=" + text +
                     ": expected auto, or seconds from 0 to 1");
  }
  return seconds;
}

}  // namespace

ReaderOptions ImagesFromFlags() {
  ReaderOptions options = FramesFromFlags();
  options.depth_scale = FLAGS_depth_scale;
  options.color_camera = FLAGS_color_camera;
  options.rolling_shutter = ParseRollingShutter(FLAGS_rolling_shutter);
  options.skip_bad_frames = FLAGS_skip_bad_frames;
  if (!FLAGS_intrinsics.empty()) {
    options.camera = ParseIntrinsics(FLAGS_intrinsics);
  }
  options.Check();
  return options;
}

}  // namespace splitfusion
