#ifndef SPLITFUSION_LIB_EVALUATION_MOTION_CALIBRATION_H_
#define SPLITFUSION_LIB_EVALUATION_MOTION_CALIBRATION_H_

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/evaluation/ground_truth.h"
#include "splitfusion/lib/evaluation/recorded_run.h"

namespace splitfusion {

/// How one point was carried from one frame to the next, camera frame, metres.
struct MotionError {
  std::array<double, 3> error{};  ///< Where it came to, less where it is.
  /// Standard deviations that the run has of that, along the same axes.
  std::array<double, 3> sigma{};
};

/// How the standard deviations of a run compare with its true errors.
struct MotionCalibration {
  int points = 0;    ///< Motions of points that were compared.
  double scale = 1;  ///< That the deviations were multiplied by.
  /// With which as many of all errors lie within two deviations as of a normal
  /// distribution, erf(sqrt 2) = 0.954; 0 without points.
  double fitted_scale = 0;
  /// Share (0..1) of the errors along x, y and z that lie within two
  /// deviations, multiplied by `scale`.
  std::array<double, 3> within_two{};
  /// For x, y and z: the share that should lie within a multiple of the
  /// deviations if errors were normal, and the share that does.
  std::array<std::vector<std::pair<double, double>>, 3> curves;
};

/// Errors of the motions between frames that have uncertainties
/// (RUN/uncertainty) and their successors, for the true points that are visible
/// in both. A point is given to the run in the first frame and carried into the
/// second (FollowPoints()). As the two frames were solved one after the other,
/// each from its own images, the deviation of the motion along an axis is
/// sqrt(sigma_1^2 + sigma_2^2) of the vertices nearest to the point in the two
/// frames; points without a vertex within 2 cm are left out. What slides along
/// the surface from frame to frame adds up in time: of that no solve knows, and
/// it is not compared.
///
/// `every`: of the frames that have both, every n-th.
/// @throw InputError if the run or the truth lacks what is needed, or a file is
///     broken.
std::vector<MotionError> MotionErrors(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, int every);

/// Compares the errors with their deviations, multiplied by `scale` > 0.
MotionCalibration Calibrate(const std::vector<MotionError>& errors,
                            double scale);

/// Object with the members of the calibration, by their names.
nlohmann::ordered_json ToJson(const MotionCalibration& calibration);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_MOTION_CALIBRATION_H_
