#ifndef SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_
#define SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_

#include <tbb/global_control.h>

#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {

/// Which frames are read, from the flags that tools over sequences share; the
/// rest of the options is left at its defaults.
///
/// @throw InputError if --sequence is missing or a value is out of its range.
ReaderOptions FramesFromFlags();

/// --threads, or one a core. @throw InputError if it is out of its range.
int ThreadsFromFlags();

/// Limits the threads of TBB and OpenCV to --threads while it lives.
class ThreadLimit {
 public:
  /// @throw InputError if --threads is out of its range.
  ThreadLimit();

 private:
  tbb::global_control control_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_
