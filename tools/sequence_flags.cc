#include "sequence_flags.h"

#include <gflags/gflags.h>

#include <opencv2/core.hpp>
#include <thread>

#include "splitfusion/lib/base/error.h"

DEFINE_string(sequence, "", "Folder of the sequence.");
DEFINE_string(format, "auto",
              "Of the sequence: tum, 7scenes, or auto, what recognises it.");
DEFINE_int32(first_frame, 0, "Frames before it are skipped.");
DEFINE_int32(max_frames, 0, "Frames read at most; 0 = all.");
DEFINE_int32(threads, 2, "Threads of all but Ceres; 0 = one for each core.");

namespace splitfusion {
int ThreadsFromFlags() {
  CheckOption(FLAGS_threads >= 0 && FLAGS_threads <= 1024, "threads",
              FLAGS_threads, "1..1024, or 0 for one a core");
  if (FLAGS_threads > 0) return FLAGS_threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ReaderOptions FramesFromFlags() {
  CheckOption(!FLAGS_sequence.empty(), "sequence", "''",
              "the folder of a sequence");
  ReaderOptions options;
  options.format = FLAGS_format;
  options.first_frame = FLAGS_first_frame;
  options.max_frames = FLAGS_max_frames;
  options.Check();
  return options;
}

ThreadLimit::ThreadLimit()
    : control_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(ThreadsFromFlags())) {
  cv::setNumThreads(ThreadsFromFlags());
}

}  // namespace splitfusion
