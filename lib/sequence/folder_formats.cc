#include "splitfusion/lib/sequence/folder_formats.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/info_file.h"
#include "splitfusion/lib/sequence/numbered_files.h"
#include "splitfusion/lib/sequence/paired_folders.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kDepthFolder[] = "depth";
constexpr double kFolderDepthScale = 1000;  // Millimetres.
constexpr std::size_t kLogBlock = 5;        // Lines.

/// A folder of depth images and one of colour images.
class FolderFormat : public SequenceFormat {
 public:
  bool Recognises(const std::string& sequence) const override {
    return fs::is_directory(fs::path(sequence) / kDepthFolder) &&
           !FirstFolder(sequence, ColorFolders()).empty();
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    const std::string color = FirstFolder(sequence, ColorFolders());
    if (color.empty()) {
      throw InputError(sequence + ": no folder of colour images: expected " +
                       Files());
    }
    return PairFolders(sequence, color, kDepthFolder);
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found =
        SequenceFormat::FindCalibration(sequence);
    if (!found) found = OwnCalibration(sequence);
    if (found && found->depth_scale == 0) {
      found->depth_scale = kFolderDepthScale;
    }
    return found;
  }

 protected:
  virtual std::vector<std::string> ColorFolders() const { return {"color"}; }

  /// That of the layout, where no file of the usual names is there.
  virtual std::optional<Calibration> OwnCalibration(const std::string&) const {
    return std::nullopt;
  }
};

/// Size of an image as decoded or, cheaper, by its header.
cv::Size SizeOfImage(const std::string& path) {
  const std::optional<ImageHeader> header = ReadImageHeader(path);
  return header ? header->size : ReadColorImage(path).size();
}

class ScanNetFormat : public FolderFormat {
 public:
  std::string Files() const override {
    return "color/, depth/ and intrinsic/intrinsic_depth.txt";
  }

  bool Recognises(const std::string& sequence) const override {
    return !MatrixFile(sequence, "intrinsic", "depth").empty() &&
           FolderFormat::Recognises(sequence);
  }

  Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const override {
    return ReadPoseFiles(frames, [&](const std::string& depth) {
      const std::string stem = fs::path(depth).stem().string();
      return (fs::path(sequence) / "pose" / (stem + ".txt")).string();
    });
  }

 protected:
  std::optional<Calibration> OwnCalibration(
      const std::string& sequence) const override {
    const std::string depth = MatrixFile(sequence, "intrinsic", "depth");
    const std::string color = MatrixFile(sequence, "intrinsic", "color");
    if (depth.empty()) return std::nullopt;
    if (color.empty()) return ReadForeignCalibration(depth);
    const AssociatedFiles first = FindFrames(sequence).front();
    const auto size = [&](const std::string& file) {
      return SizeOfImage((fs::path(sequence) / file).string());
    };
    TwoCameras cameras;
    cameras.color_size = size(first.color.file);
    cameras.depth_size = size(first.depth.file);
    cameras.color_intrinsic = ReadMatrix(color);
    cameras.depth_intrinsic = ReadMatrix(depth);
    cameras.color_extrinsic = Extrinsic(sequence, "color");
    cameras.depth_extrinsic = Extrinsic(sequence, "depth");
    return CalibrationOf(color, depth, cameras);
  }

 private:
  /// The file of a matrix, by the names that are in use; empty if none is
  /// there.
  static std::string MatrixFile(const std::string& sequence,
                                const std::string& kind,
                                const std::string& camera) {
    const std::string name = kind + "_" + camera + ".txt";
    for (const fs::path& file :
         {fs::path("intrinsic") / name, fs::path("intrinsics") / name,
          fs::path(name), fs::path(kind + "s_" + camera + ".txt")}) {
      const fs::path path = fs::path(sequence) / file;
      if (fs::exists(path)) return path.string();
    }
    return "";
  }

  static Rigid3d Extrinsic(const std::string& sequence,
                           const std::string& camera) {
    const std::string path = MatrixFile(sequence, "extrinsic", camera);
    if (path.empty()) return Rigid3d::Identity();
    return KnownRigidMotion(path, ReadMatrix(path, 4, 4));
  }
};

class DeepDeformFormat : public FolderFormat {
 public:
  std::string Files() const override {
    return "color/000000.jpg, depth/000000.png, ... and intrinsics.txt";
  }

  bool Recognises(const std::string& sequence) const override {
    return fs::exists(fs::path(sequence) / "intrinsics.txt") &&
           FolderFormat::Recognises(sequence);
  }
};

/// The numbers of a line.
///
/// @throw InputError unless it has so many.
std::vector<double> LogNumbers(const TextLine& line, int count) {
  std::istringstream words(line.text);
  std::vector<double> numbers(count);
  for (double& number : numbers) words >> number;
  if (!words || !(words >> std::ws).eof()) {
    line.Refuse(std::to_string(count) +
                " numbers: blocks of an index line and a 4x4 matrix");
  }
  return numbers;
}

class RedwoodFormat : public FolderFormat {
 public:
  std::string Files() const override {
    return "depth/ and color/, rgb/ or image/";
  }

  Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const override {
    const fs::path log = fs::path(sequence) / "trajectory.log";
    if (!fs::exists(log)) return FolderFormat::FindPoses(sequence, frames);
    const std::vector<AssociatedFiles> all = FindFrames(sequence);
    const std::vector<TextLine> lines = ReadTextLines(log.string());
    if (lines.empty() || lines.size() % kLogBlock != 0) {
      throw InputError(log.string() + ": " + std::to_string(lines.size()) +
                       " lines: expected blocks of an index line and a 4x4 "
                       "matrix");
    }
    Trajectory poses;
    for (std::size_t at = 0; at < lines.size(); at += kLogBlock) {
      const double index = LogNumbers(lines[at], 3)[0];
      cv::Mat_<double> matrix(4, 4);
      for (int row = 0; row < 4; ++row) {
        const std::vector<double> numbers = LogNumbers(lines[at + 1 + row], 4);
        std::copy(numbers.begin(), numbers.end(), matrix[row]);
      }
      const auto pose = RigidMotion(lines[at].place, matrix);
      if (!pose || !(index >= 0 && index < static_cast<double>(all.size()))) {
        continue;
      }
      poses.push_back(
          {all[static_cast<std::size_t>(index)].depth.timestamp, *pose});
    }
    return poses;
  }

 protected:
  std::vector<std::string> ColorFolders() const override {
    return {"color", "rgb", "image"};
  }

  std::optional<Calibration> OwnCalibration(
      const std::string& sequence) const override {
    const std::string first = FindFrames(sequence).front().depth.file;
    // An index of seven digits, then a time of twelve.
    const std::string stem = fs::path(first).stem().string();
    if (stem.size() != 20 || stem[7] != '-') return std::nullopt;
    return Calibration{{640, 480, 525, 525, 319.5, 239.5}, kFolderDepthScale};
  }
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeScanNetFormat() {
  return std::make_unique<ScanNetFormat>();
}

std::unique_ptr<SequenceFormat> MakeDeepDeformFormat() {
  return std::make_unique<DeepDeformFormat>();
}

std::unique_ptr<SequenceFormat> MakeRedwoodFormat() {
  return std::make_unique<RedwoodFormat>();
}

}  // namespace splitfusion
