#ifndef SPLITFUSION_LIB_SEQUENCE_CALIBRATION_FILES_H_
#define SPLITFUSION_LIB_SEQUENCE_CALIBRATION_FILES_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/sequence/calibration.h"

namespace splitfusion {

/// Reads a text file of rows of numbers, separated by blanks or commas, all of
/// one length.
///
/// @throw InputError on a missing file, a word that is no number, or another
///     shape than `rows` x `columns`; 0 = any up to 4.
cv::Mat_<double> ReadMatrix(const std::string& path, int rows = 0,
                            int columns = 0);

/// Sets fx, fy, cx, cy from a 3x3 or 4x4 matrix of intrinsics.
///
/// @throw InputError if it is none; `place` names it.
void SetIntrinsics(const std::string& place, const cv::Mat_<double>& matrix,
                   PinholeCamera* camera);

/// The distortion that coefficients are, by the name that ROS gives its model.
///
/// @throw InputError if it is neither plumb_bob nor rational_polynomial, unless
///     all are 0; `place` names it.
LensDistortion MakeLensDistortion(const std::string& place,
                                  const std::string& model,
                                  const std::vector<double>& coefficients);

/// The rigid motion that a 4x4 matrix is, its rotation made one exactly; none
/// if a number is not finite, which is how data sets mark poses that are not
/// known.
///
/// @throw InputError if it is no rigid motion; `place` names it.
std::optional<Rigid3d> RigidMotion(const std::string& place,
                                   const cv::Mat_<double>& matrix);

/// The same of what must be known, as the place of a camera on its device.
///
/// @throw InputError also if a number is not finite.
Rigid3d KnownRigidMotion(const std::string& place,
                         const cv::Mat_<double>& matrix);

/// Reads intrinsics in a form of others. Where the file does not tell them,
/// size and depth scale are 0.
///
/// `path`: ends in `.txt`: a 3x3 or 4x4 matrix; `.json`: that of Open3D
/// (`width`, `height`, `intrinsic_matrix` by columns, `depth_scale`); `.yaml`
/// or
/// `.yml`: that of OpenCV's calibration programs or `camera_info` of ROS
/// (`image_width`, `image_height`, `camera_matrix`,
/// `distortion_coefficients`; or `width`, `height`, `K`, `D`).
///
/// @throw InputError if it is missing or broken, or has distortion of another
///     model than LensDistortion.
Calibration ReadForeignCalibration(const std::string& path);

/// Reads the first of the files that others call their calibration, in a
/// folder; empty if there is none.
///
/// @throw InputError if it is broken.
std::optional<Calibration> FindForeignCalibration(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEQUENCE_CALIBRATION_FILES_H_
