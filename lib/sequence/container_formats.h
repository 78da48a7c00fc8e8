#ifndef SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_
#define SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_

#include <memory>

#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// A recording of ScanNet, one file that ends in `.sens`; 30 frames a second.
std::unique_ptr<SequenceFormat> MakeSensFormat();

/// A recording of ROS 1, one file that ends in `.bag`, for a build with
/// librosbag-storage: the images of a topic whose name has "depth" in it, one
/// with "registered" or "aligned" first, with those of one that has "rgb" or
/// "color", paired by time stamp; `camera_info` beside them. Depth of 16 bit in
/// millimetres.
std::unique_ptr<SequenceFormat> MakeRosBagFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_
