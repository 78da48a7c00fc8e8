#ifndef SPLITFUSION_LIB_SEQUENCE_TUM_FORMATS_H_
#define SPLITFUSION_LIB_SEQUENCE_TUM_FORMATS_H_

#include <memory>
#include <string>

#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// Poses that come with a sequence: ReadTumTrajectory().
///
/// @throw InputError also if the file has none.
Trajectory ReadTumPoses(const std::string& path);

/// The layout of the TUM RGB-D benchmark: `associations.txt`, or else `rgb.txt`
/// and `depth.txt` paired by time stamp; colour png or jpg; depth 16-bit PNG.
/// Without a calibration file folders named after the benchmark's cameras,
/// `rgbd_dataset_freiburg1_...` to 3, have the intrinsics and the distortion of
/// its page.
std::unique_ptr<SequenceFormat> MakeTumFormat();

/// The Bonn RGB-D Dynamic data set: the TUM layout in folders whose name begins
/// with `rgbd_bonn_`. Without a calibration file it has the intrinsics and the
/// distortion that the authors give.
std::unique_ptr<SequenceFormat> MakeBonnFormat();

/// The PNG images of ICL-NUIM that are "compatible with TUM": the TUM layout in
/// folders whose name ends in `_frei_png` or that hold a `*.gt.freiburg`. Time
/// stamps are frame numbers, 30 a second. Poses are of a camera whose y axis
/// points up, which is why the authors give a negative fy; the images are not,
/// so that poses are mirrored and fy is positive.
std::unique_ptr<SequenceFormat> MakeIclNuimFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_TUM_FORMATS_H_
