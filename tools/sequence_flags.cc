#include "sequence_flags.h"

#include <gflags/gflags.h>

#include "splitfusion/lib/base/error.h"

DEFINE_string(sequence, "", "Folder of the sequence, or its one file.");
DEFINE_string(format, "auto", "Layout, docs/data_sets.md; auto: recognised.");
DEFINE_int32(first_frame, 0, "Frames before it are skipped.");
DEFINE_int32(frame_step, 1, "Of the frames every so many is read.");
DEFINE_int32(max_frames, 0, "Frames read at most; 0 = all.");
DEFINE_int32(threads, 2, "Threads of all but Ceres; 0 = one for each core.");

namespace splitfusion {
ReaderOptions FramesFromFlags() {
  CheckOption(!FLAGS_sequence.empty(), "sequence", "''",
              "the folder of a sequence");
  ReaderOptions options;
  options.format = FLAGS_format;
  options.first_frame = FLAGS_first_frame;
  options.frame_step = FLAGS_frame_step;
  options.max_frames = FLAGS_max_frames;
  options.Check();
  return options;
}

}  // namespace splitfusion
