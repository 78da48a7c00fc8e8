#ifndef SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_
#define SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_

#include <memory>

#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// A recording of ScanNet, one file that ends in `.sens`; 30 frames a second.
std::unique_ptr<SequenceFormat> MakeSensFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_CONTAINER_FORMATS_H_
