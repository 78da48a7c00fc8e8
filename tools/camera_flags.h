#ifndef SPLITFUSION_TOOLS_CAMERA_FLAGS_H_
#define SPLITFUSION_TOOLS_CAMERA_FLAGS_H_

#include "splitfusion/lib/sequence/image_folder_reader.h"

namespace splitfusion {

/// FramesFromFlags() with the flags of what decodes its images: intrinsics,
/// depth scale, colour camera, and what becomes of broken ones.
///
/// @throw InputError if --sequence is missing or a value is out of its range.
ReaderOptions ImagesFromFlags();

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_CAMERA_FLAGS_H_
