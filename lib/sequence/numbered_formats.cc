#include "splitfusion/lib/sequence/numbered_formats.h"

#include <filesystem>
#include <map>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/info_file.h"
#include "splitfusion/lib/sequence/numbered_files.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "frame-";
constexpr char kDepth[] = ".depth.png";
constexpr int kNoMeasurement = 65535;
constexpr double kMillimetres = 1000;

/// `frame-000000` of `frame-000000.color.png`.
std::string StemOf(const std::string& file) {
  return file.substr(0, file.find('.'));
}

/// One folder with all files of all frames, `frame-000000.*`.
class NumberedFormat : public SequenceFormat {
 public:
  std::string Files() const override {
    return "frame-000000" + ColorEnding() + ", frame-000000.depth.png, ...";
  }

  bool Recognises(const std::string& sequence) const override {
    return !ColorFiles(sequence).empty();
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    const fs::path below = Below(sequence);
    const std::string folder = (fs::path(sequence) / below).string();
    std::vector<AssociatedFiles> frames = PairByNumber(
        ColorFiles(folder),
        NumberedFiles(folder, kPrefix, {kDepth, ".depth.pgm"}),
        [&](const std::string& depth) { return StemOf(depth) + ColorEnding(); },
        [](const std::string& color) { return StemOf(color) + kDepth; });
    if (frames.empty()) {
      throw InputError(sequence + ": 0 frames: expected " + Files());
    }
    for (AssociatedFiles& frame : frames) {
      frame.color.file = (below / frame.color.file).string();
      frame.depth.file = (below / frame.depth.file).string();
    }
    return frames;
  }

  Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const override {
    return ReadPoseFiles(frames, [&](const std::string& depth) {
      const fs::path path = fs::path(sequence) / depth;
      return (path.parent_path() /
              (StemOf(path.filename().string()) + ".pose.txt"))
          .string();
    });
  }

  cv::Mat ReadDepth(const std::string& path) const override {
    cv::Mat depth = SequenceFormat::ReadDepth(path);
    if (depth.depth() == CV_16U) depth.setTo(0, depth == kNoMeasurement);
    return depth;
  }

 protected:
  virtual std::string ColorEnding() const { return ".color.png"; }

  /// The subfolder that holds the files; empty for the folder itself.
  virtual fs::path Below(const std::string&) const { return {}; }

  std::map<std::int64_t, std::string> ColorFiles(
      const std::string& folder) const {
    return NumberedFiles(folder, kPrefix, {ColorEnding()});
  }
};

class SevenScenesFormat : public NumberedFormat {
 public:
  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found =
        NumberedFormat::FindCalibration(sequence);
    if (!found) found = Calibration{{640, 480, 585, 585, 320, 240}, 0};
    if (found->depth_scale == 0) found->depth_scale = kMillimetres;
    return found;
  }
};

class VolumeDeformFormat : public NumberedFormat {
 public:
  std::string Files() const override {
    return std::string(kIntrinsics) + " and " + NumberedFormat::Files();
  }

  bool Recognises(const std::string& sequence) const override {
    const fs::path folder = fs::path(sequence) / Below(sequence);
    return fs::exists(IntrinsicsOf(sequence)) &&
           NumberedFormat::Recognises(folder.string());
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found =
        NumberedFormat::FindCalibration(sequence);
    // The colour camera's own are there, too, but not where it is: that is
    // estimated from the images, see EstimateColorCamera().
    if (!found) {
      found = ReadForeignCalibration(IntrinsicsOf(sequence).string());
    }
    if (found->depth_scale == 0) found->depth_scale = kMillimetres;
    return found;
  }

 protected:
  fs::path Below(const std::string& sequence) const override {
    return fs::is_directory(fs::path(sequence) / "data") ? "data" : "";
  }

 private:
  static constexpr const char* kIntrinsics = "depthIntrinsics.txt";

  fs::path IntrinsicsOf(const std::string& sequence) const {
    const fs::path beside = fs::path(sequence) / kIntrinsics;
    if (fs::exists(beside)) return beside;
    return fs::path(sequence) / Below(sequence) / kIntrinsics;
  }
};

class BundleFusionFormat : public NumberedFormat {
 public:
  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    std::optional<Calibration> found =
        NumberedFormat::FindCalibration(sequence);
    for (const char* name : {"info.txt", "_info.txt"}) {
      const fs::path file = fs::path(sequence) / name;
      if (!found && fs::exists(file)) found = ReadInfoFile(file.string());
    }
    if (found && found->depth_scale == 0) found->depth_scale = kMillimetres;
    return found;
  }

 protected:
  std::string ColorEnding() const override { return ".color.jpg"; }
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeSevenScenesFormat() {
  return std::make_unique<SevenScenesFormat>();
}

std::unique_ptr<SequenceFormat> MakeVolumeDeformFormat() {
  return std::make_unique<VolumeDeformFormat>();
}

std::unique_ptr<SequenceFormat> MakeBundleFusionFormat() {
  return std::make_unique<BundleFusionFormat>();
}

}  // namespace splitfusion
