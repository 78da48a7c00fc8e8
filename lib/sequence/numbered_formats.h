#ifndef SPLITFUSION_LIB_SEQUENCE_NUMBERED_FORMATS_H_
#define SPLITFUSION_LIB_SEQUENCE_NUMBERED_FORMATS_H_

#include <memory>

#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// The layout of the 7-Scenes data set: `frame-000000.color.png`,
/// `frame-000000.depth.png` in millimetres, 65535 where nothing was measured,
/// `frame-000000.pose.txt`; 30 frames a second. Without a calibration file the
/// intrinsics are those that the authors give for depth, 585 585 320 240 at
/// 640x480.
std::unique_ptr<SequenceFormat> MakeSevenScenesFormat();

/// The layout of the VolumeDeform data set: that of 7-Scenes, and
/// `depthIntrinsics.txt`, a 4x4 matrix; folders, or their subfolder `data`.
std::unique_ptr<SequenceFormat> MakeVolumeDeformFormat();

/// The layout of the BundleFusion data set, and of what ScanNet's tools unpack:
/// `frame-000000.color.jpg`, `frame-000000.depth.png` (or `.pgm`),
/// `frame-000000.pose.txt`, and `info.txt` or `_info.txt` with the calibration
/// of both cameras.
std::unique_ptr<SequenceFormat> MakeBundleFusionFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_NUMBERED_FORMATS_H_
