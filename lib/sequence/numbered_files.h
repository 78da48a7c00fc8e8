#ifndef SPLITFUSION_LIB_SEQUENCE_NUMBERED_FILES_H_
#define SPLITFUSION_LIB_SEQUENCE_NUMBERED_FILES_H_

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/association_list.h"
#include "splitfusion/lib/sequence/trajectory.h"

namespace splitfusion {

/// Frames a second of recordings without time stamps.
constexpr double kNumberedFramesPerSecond = 30;

/// Names of the files of a folder that are `prefix`, a number, and one of the
/// endings, by number; none if there is no such folder. Of two files of one
/// number that of the first ending counts.
std::map<std::int64_t, std::string> NumberedFiles(
    const std::string& folder, const std::string& prefix,
    const std::vector<std::string>& endings);

/// Frames of numbered colour and depth images, kNumberedFramesPerSecond.
/// `color_name` and `depth_name`: what the image beside one of the other kind
/// should be called, if there is none of its number; it makes the frame a bad
/// one.
std::vector<AssociatedFiles> PairByNumber(
    const std::map<std::int64_t, std::string>& color,
    const std::map<std::int64_t, std::string>& depth,
    const std::function<std::string(const std::string&)>& color_name,
    const std::function<std::string(const std::string&)>& depth_name);

/// Poses of the frames whose file is there: 4x4 matrices, world from camera;
/// those that are not finite are left out. `pose_name`: path of the pose of a
/// depth file.
///
/// @throw InputError if a file is there but broken.
Trajectory ReadPoseFiles(
    const std::vector<AssociatedFiles>& frames,
    const std::function<std::string(const std::string&)>& pose_name);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_NUMBERED_FILES_H_
