#include "splitfusion/lib/sequence/tum_formats.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration_files.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Largest difference of the time stamps of a pair, seconds.
constexpr double kTimeTolerance = 0.02;
constexpr double kTumDepthScale = 5000;
constexpr double kIclFramesPerSecond = 30;

/// Name of a folder, also of "folder/" and ".".
std::string NameOf(const std::string& folder) {
  std::error_code error;
  const fs::path path = fs::weakly_canonical(folder, error);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// A colour camera of the benchmark, to which depth is registered.
struct BenchmarkCamera {
  const char* name;  // Part of the names of its folders.
  PinholeCamera camera;
  LensDistortion lens;
};

/// What the benchmark's page gives.
const std::array<BenchmarkCamera, 3>& BenchmarkCameras() {
  static const std::array<BenchmarkCamera, 3> cameras = {{
      {"freiburg1",
       {640, 480, 517.3, 516.5, 318.6, 255.3},
       {{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}}},
      {"freiburg2",
       {640, 480, 520.9, 521.0, 325.1, 249.7},
       {{0.2312, -0.7849, -0.0033, -0.0001, 0.9172}}},
      {"freiburg3", {640, 480, 535.4, 539.2, 320.1, 247.6}, {}},
  }};
  return cameras;
}

/// That of a folder; none for another folder.
std::optional<Calibration> BenchmarkCalibration(const std::string& folder) {
  for (const BenchmarkCamera& known : BenchmarkCameras()) {
    if (folder.find(known.name) == std::string::npos) continue;
    Calibration found{known.camera, kTumDepthScale};
    found.lens = known.lens;
    return found;
  }
  return std::nullopt;
}

/// The lens of the benchmark's camera that has the same intrinsics: files name
/// these alone, and the images of the benchmark are not undistorted.
LensDistortion BenchmarkLens(const PinholeCamera& camera) {
  for (const BenchmarkCamera& known : BenchmarkCameras()) {
    const PinholeCamera& c = known.camera;
    if (camera.width == c.width && camera.height == c.height &&
        camera.fx == c.fx && camera.fy == c.fy && camera.cx == c.cx &&
        camera.cy == c.cy) {
      return known.lens;
    }
  }
  return {};
}

class TumFormat : public SequenceFormat {
 public:
  std::string Files() const override {
    return "associations.txt, or rgb.txt and depth.txt";
  }

  bool Recognises(const std::string& sequence) const override {
    for (const char* list : {"associations.txt", "rgb.txt", "depth.txt"}) {
      if (fs::exists(fs::path(sequence) / list)) return true;
    }
    return false;
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    return FindAssociations(sequence, kTimeTolerance);
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    auto found = SequenceFormat::FindCalibration(sequence);
    if (!found) return BenchmarkCalibration(NameOf(sequence));
    if (!found->lens_is_stated) found->lens = BenchmarkLens(found->camera);
    return found;
  }
};

class BonnFormat : public TumFormat {
 public:
  std::string Files() const override {
    return "rgb.txt and depth.txt in a folder rgbd_bonn_...";
  }

  bool Recognises(const std::string& sequence) const override {
    return NameOf(sequence).rfind("rgbd_bonn", 0) == 0 &&
           TumFormat::Recognises(sequence);
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found = TumFormat::FindCalibration(sequence);
    if (!found) {
      found.emplace();
      found->camera = {640,        480,        542.822841,
                       542.576870, 315.593520, 237.756098};
      found->lens.coefficients = {0.039903, -0.099343, -0.000730, -0.000144};
    }
    if (found->depth_scale == 0) found->depth_scale = kTumDepthScale;
    return found;
  }
};

/// The first file of a folder, by name, that ends in `ending`; empty if none.
std::string FirstEndingIn(const std::string& folder,
                          const std::string& ending) {
  std::error_code error;
  std::string first;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(folder, error)) {
    const std::string path = entry.path().string();
    const bool ends =
        path.size() > ending.size() &&
        path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
    if (ends && (first.empty() || path < first)) first = path;
  }
  return first;
}

/// The pose in a world, and of a camera, whose y axes point the other way.
Rigid3d MirroredInY(const Rigid3d& pose) {
  const Eigen::DiagonalMatrix<double, 3> mirror(1, -1, 1);
  Rigid3d mirrored = Rigid3d::Identity();
  mirrored.linear() = mirror * pose.linear() * mirror;
  mirrored.translation() = mirror * pose.translation();
  return mirrored;
}

class IclNuimFormat : public TumFormat {
 public:
  std::string Files() const override {
    return "associations.txt and a *.gt.freiburg, or in a folder "
           "..._frei_png";
  }

  bool Recognises(const std::string& sequence) const override {
    const bool named =
        NameOf(sequence).find("_frei_png") != std::string::npos ||
        !FirstEndingIn(sequence, kPoses).empty();
    return named && TumFormat::Recognises(sequence);
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    std::vector<AssociatedFiles> frames = TumFormat::FindFrames(sequence);
    for (AssociatedFiles& frame : frames) {
      frame.color.timestamp /= kIclFramesPerSecond;
      frame.depth.timestamp /= kIclFramesPerSecond;
    }
    return frames;
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found = TumFormat::FindCalibration(sequence);
    if (!found) {
      found.emplace();
      found->camera = {640, 480, 481.20, 480, 319.5, 239.5};
    }
    if (found->depth_scale == 0) found->depth_scale = kTumDepthScale;
    return found;
  }

  Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const override {
    const std::string path = FirstEndingIn(sequence, kPoses);
    if (path.empty()) return TumFormat::FindPoses(sequence, frames);
    Trajectory poses = ReadTumPoses(path);
    for (TimedPose& pose : poses) {
      pose.timestamp /= kIclFramesPerSecond;
      pose.world_from_camera = MirroredInY(pose.world_from_camera);
    }
    return poses;
  }

 private:
  static constexpr const char* kPoses = ".gt.freiburg";
};

}  // namespace

Trajectory ReadTumPoses(const std::string& path) {
  Trajectory poses = ReadTumTrajectory(path);
  if (!poses.empty()) return poses;
  throw InputError(path +
                   ": 0 poses: expected lines 'timestamp tx ty tz qx qy qz "
                   "qw'");
}

std::unique_ptr<SequenceFormat> MakeTumFormat() {
  return std::make_unique<TumFormat>();
}

std::unique_ptr<SequenceFormat> MakeBonnFormat() {
  return std::make_unique<BonnFormat>();
}

std::unique_ptr<SequenceFormat> MakeIclNuimFormat() {
  return std::make_unique<IclNuimFormat>();
}

}  // namespace splitfusion
