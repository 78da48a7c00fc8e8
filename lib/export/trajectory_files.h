#ifndef SPLITFUSION_LIB_EXPORT_TRAJECTORY_FILES_H_
#define SPLITFUSION_LIB_EXPORT_TRAJECTORY_FILES_H_

#include <string>

#include "splitfusion/lib/export/export_scene.h"

namespace splitfusion {

/// Writes the poses of the camera in the world as TUM text, one line a frame.
///
/// @throw InputError if the file cannot be written.
void WriteTumPoses(const std::string& path, const ExportScene& scene);

/// The same as of KITTI's odometry benchmark: the upper three rows of the
/// matrix world from camera, row by row, 12 numbers a line.
void WriteKittiPoses(const std::string& path, const ExportScene& scene);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_TRAJECTORY_FILES_H_
