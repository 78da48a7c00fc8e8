#ifndef SPLITFUSION_LIB_SEQUENCE_FOLDER_FORMATS_H_
#define SPLITFUSION_LIB_SEQUENCE_FOLDER_FORMATS_H_

#include <memory>

#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {

/// What ScanNet's tools unpack, and the data sets that took that layout over:
/// `color/0.jpg`, `depth/0.png` in millimetres, `pose/0.txt`, and matrices of
/// both cameras, `intrinsic/intrinsic_depth.txt`, `intrinsic_color.txt`,
/// `extrinsic_depth.txt`, `extrinsic_color.txt`.
std::unique_ptr<SequenceFormat> MakeScanNetFormat();

/// The layout of DeepDeform: `color/000000.jpg`, `depth/000000.png` in
/// millimetres, registered, and `intrinsics.txt`, a 4x4 matrix.
std::unique_ptr<SequenceFormat> MakeDeepDeformFormat();

/// Folders as of Redwood's data and Open3D's recorders: `depth/`, and `color/`,
/// `rgb/` or `image/`, see PairFolders(); intrinsics of Open3D
/// (`camera_intrinsic.json`, `intrinsic.json`), or another calibration file;
/// Redwood's own files (`0000001-000000033369.jpg`) without one have those of a
/// PrimeSense, 525 525 319.5 239.5 at 640x480. Millimetres unless a file tells.
/// Poses are those of `trajectory.log`, blocks of an index line and a 4x4
/// matrix.
std::unique_ptr<SequenceFormat> MakeRedwoodFormat();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_FOLDER_FORMATS_H_
