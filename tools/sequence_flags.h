#ifndef SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_
#define SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_

#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {

/// Which frames are read, from the flags that tools over sequences share; the
/// rest of the options is left at its defaults.
///
/// @throw InputError if --sequence is missing or a value is out of its range.
ReaderOptions FramesFromFlags();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_SEQUENCE_FLAGS_H_
