#include "splitfusion/lib/evaluation/motion_calibration.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/point_follower.h"
#include "splitfusion/lib/evaluation/true_tracks.h"
#include "splitfusion/lib/geometry/nearest_point.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Largest distance of a point from the vertex that it is compared with,
/// metres.
constexpr float kPairReach = 0.02F;

/// Steps of the curves, in deviations, and their number.
constexpr double kStep = 0.1;
constexpr int kSteps = 40;

/// Share of a normal distribution within so many deviations.
double NormalShare(double deviations) {
  return std::erf(deviations / std::sqrt(2.0));
}

/// The deviations of all surfaces in one frame.
class FrameDeviations {
 public:
  /// @throw InputError if a file is broken or has no deviations.
  explicit FrameDeviations(const std::vector<std::string>& files) {
    std::vector<Eigen::Vector3f> vertices;
    for (const std::string& file : files) {
      PlyProperties properties;
      const TriangleMesh mesh = ReadPly(file, &properties);
      vertices.insert(vertices.end(), mesh.vertices.begin(),
                      mesh.vertices.end());
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name = std::string("sigma_") + "xyz"[axis];
        const std::vector<double>& values = properties[name];
        if (values.size() != mesh.vertices.size()) {
          throw InputError(file + ": expected the property " + name);
        }
        for (const double sigma : values) {
          if (std::isfinite(sigma)) continue;
          throw InputError(file + ": " + name + " is not finite");
        }
        sigmas_[axis].insert(sigmas_[axis].end(), values.begin(), values.end());
      }
    }
    if (!vertices.empty()) tree_.emplace(vertices);
  }

  /// Of the nearest vertex, squared; none if that is too far.
  std::optional<Eigen::Vector3d> VarianceAt(const Eigen::Vector3d& p) const {
    if (!tree_) return std::nullopt;
    float distance = 0;
    const int vertex = tree_->Find(p.cast<float>(), -1, &distance);
    if (distance > kPairReach) return std::nullopt;
    Eigen::Vector3d variance;
    for (int axis = 0; axis < 3; ++axis) {
      variance[axis] = sigmas_[axis][vertex] * sigmas_[axis][vertex];
    }
    return variance;
  }

 private:
  std::optional<NearestPoint> tree_;
  std::array<std::vector<double>, 3> sigmas_;
};

/// The files RUN/uncertainty/FRAME_NNN.ply by frame.
std::map<int, std::vector<std::string>> UncertaintyFiles(
    const std::string& root) {
  std::map<int, std::vector<std::string>> files;
  const fs::path folder = fs::path(root) / "uncertainty";
  if (fs::is_directory(folder)) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string frame = entry.path().stem().string().substr(0, 6);
      if (entry.path().extension() != ".ply" || frame.size() != 6 ||
          frame.find_first_not_of("0123456789") != std::string::npos) {
        continue;
      }
      files[std::stoi(frame)].push_back(entry.path().string());
    }
  }
  for (auto& [frame, paths] : files) std::sort(paths.begin(), paths.end());
  return files;
}

/// What the motions of a run are compared with.
struct Truth {
  const TrueTracks& tracks;
  const Trajectory& trajectory;

  Eigen::Vector3d InCamera(int frame, int point) const {
    return trajectory[frame].world_from_camera.inverse() *
           tracks.Position(frame, point);
  }
  bool Has(int frame) const {
    return frame < tracks.frames() &&
           frame < static_cast<int>(trajectory.size());
  }
};

/// Adds the errors of the motions from a frame to the next one.
void AddErrors(const RecordedRun& run,
               const std::vector<AnimatedSurface>& surfaces, const Truth& truth,
               int frame, const FrameDeviations& before,
               const FrameDeviations& after, std::vector<MotionError>* errors) {
  const FollowedPoints followed = FollowPoints(
      run, surfaces,
      truth.tracks.Queries(frame, truth.trajectory[frame].world_from_camera),
      1);
  for (const TrackPoint& point : followed.points) {
    if (point.frame == frame || !truth.tracks.Visible(frame + 1, point.id)) {
      continue;
    }
    const auto first = before.VarianceAt(truth.InCamera(frame, point.id));
    const auto second = after.VarianceAt(point.position);
    if (!first || !second) continue;
    const Eigen::Vector3d error =
        point.position - truth.InCamera(frame + 1, point.id);
    const Eigen::Vector3d sigma = (*first + *second).cwiseSqrt();
    errors->push_back(
        {{error.x(), error.y(), error.z()}, {sigma.x(), sigma.y(), sigma.z()}});
  }
}

/// Errors along one axis in deviations, ascending.
std::vector<double> InDeviations(const std::vector<MotionError>& errors,
                                 int axis) {
  std::vector<double> sizes;
  for (const MotionError& e : errors) {
    sizes.push_back(std::abs(e.error[axis]) / e.sigma[axis]);
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes;
}

/// Share of ascending numbers that are at most `bound`; 0 of none.
double ShareWithin(const std::vector<double>& sizes, double bound) {
  const auto end = std::upper_bound(sizes.begin(), sizes.end(), bound);
  return sizes.empty() ? 0
                       : static_cast<double>(end - sizes.begin()) /
                             static_cast<double>(sizes.size());
}

}  // namespace

std::vector<MotionError> MotionErrors(
    const RecordedRun& run, const std::vector<AnimatedSurface>& surfaces,
    const GroundTruth& truth, int every) {
  CheckOption(every >= 1, "uncertainty_every", every, "a number of frames");
  const auto files = UncertaintyFiles(run.root);
  if (files.empty()) {
    throw InputError(run.root +
                     ": no uncertainty/: expected a run with "
                     "--covariance=1");
  }
  if (truth.tracks.empty()) {
    throw InputError(truth.folder + ": no tracks.bin");
  }
  const TrueTracks tracks = TrueTracks::Read(truth.tracks);
  const Truth followed{tracks, truth.trajectory};
  std::vector<MotionError> errors;
  int pairs = 0;
  for (const auto& [frame, paths] : files) {
    const auto next = files.find(frame + 1);
    if (next == files.end() || !followed.Has(frame + 1) ||
        pairs++ % every != 0) {
      continue;
    }
    AddErrors(run, surfaces, followed, frame, FrameDeviations(paths),
              FrameDeviations(next->second), &errors);
  }
  if (errors.empty()) {
    throw InputError(run.root +
                     ": no point is on a surface in two successive frames with "
                     "uncertainty/: expected a run with --covariance=1");
  }
  return errors;
}

MotionCalibration Calibrate(const std::vector<MotionError>& errors,
                            double scale) {
  CheckOption(scale > 0, "uncertainty_scale", scale, "> 0");
  MotionCalibration result;
  result.points = static_cast<int>(errors.size());
  result.scale = scale;
  std::vector<double> all;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> sizes = InDeviations(errors, axis);
    all.insert(all.end(), sizes.begin(), sizes.end());
    result.within_two[axis] = ShareWithin(sizes, 2 * scale);
    for (int i = 0; i <= kSteps; ++i) {
      result.curves[axis].emplace_back(NormalShare(i * kStep),
                                       ShareWithin(sizes, i * kStep * scale));
    }
  }
  if (all.empty()) return result;
  const auto place =
      all.begin() + static_cast<std::ptrdiff_t>(
                        NormalShare(2) * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), place, all.end());
  result.fitted_scale = *place / 2;
  return result;
}

nlohmann::ordered_json ToJson(const MotionCalibration& calibration) {
  return {{"points", calibration.points},
          {"scale", calibration.scale},
          {"fitted_scale", calibration.fitted_scale},
          {"within_two", calibration.within_two},
          {"curves", calibration.curves}};
}

}  // namespace splitfusion
