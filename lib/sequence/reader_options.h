#ifndef SPLITFUSION_LIB_SEQUENCE_READER_OPTIONS_H_
#define SPLITFUSION_LIB_SEQUENCE_READER_OPTIONS_H_

#include <optional>
#include <string>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/sequence/depth_filter.h"

namespace splitfusion {

/// How a sequence is read.
struct ReaderOptions {
  std::string format = "auto";  ///< See ResolveFormat().
  int first_frame = 0;          ///< Frames before it are skipped; indices stay.
  int frame_step = 1;           ///< Of that every so many; indices stay.
  int max_frames = 0;           ///< Frames read at most; 0 = all.
  /// Replaces the intrinsics that the format finds.
  std::optional<PinholeCamera> camera;
  /// Units a metre; replaces what the format finds; 0 = that.
  double depth_scale = 0;
  DepthOptions depth;  ///< Of every depth image.
  /// Frames whose images are missing or broken are left out; indices stay.
  bool skip_bad_frames = false;
  /// Where colour images are from that are not registered to the depth images:
  /// a file of ReadColorCamera(); "auto": `color_camera.txt` of the sequence if
  /// there is one, or else what the format finds; "none": they are registered.
  std::string color_camera = "auto";
  /// Seconds from the first row of an image that is exposed to the last one, 0:
  /// all at once; none: estimated, and 0 unless it is certain.
  std::optional<double> rolling_shutter;
  /// TUM text file of known poses, one of every frame; empty: none.
  std::string trajectory;

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_READER_OPTIONS_H_
