#include "splitfusion/lib/sequence/container_formats.h"

#include <cstdio>
#include <filesystem>

#include "splitfusion/lib/sequence/numbered_files.h"
#include "splitfusion/lib/sequence/open_files.h"
#include "splitfusion/lib/sequence/sens_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// "000012.jpg".
std::string NameInContainer(int i, const char* extension) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06d.%s", i, extension);
  return name;
}

class SensFormat : public SequenceFormat {
 public:
  std::string Files() const override { return "a file *.sens"; }

  bool Recognises(const std::string& sequence) const override {
    return fs::path(sequence).extension() == ".sens" &&
           fs::is_regular_file(sequence);
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& sequence) const override {
    const std::shared_ptr<const SensFile> file = files_.At(sequence);
    std::vector<AssociatedFiles> frames;
    for (int i = 0; i < file->size(); ++i) {
      const double time = i / kNumberedFramesPerSecond;
      frames.push_back({{time, NameInContainer(i, "jpg")},
                        {time, NameInContainer(i, "png")}});
    }
    return frames;
  }

  std::optional<Calibration> FindCalibration(
      const std::string& sequence) const override {
    return CalibrationOf(sequence + ": colour camera",
                         sequence + ": depth camera",
                         files_.At(sequence)->cameras());
  }

  Trajectory FindPoses(
      const std::string& sequence,
      const std::vector<AssociatedFiles>& frames) const override {
    const std::shared_ptr<const SensFile> file = files_.At(sequence);
    Trajectory poses;
    for (const AssociatedFiles& frame : frames) {
      const std::optional<Rigid3d> pose = file->Pose(IndexOf(frame.depth.file));
      if (pose) poses.push_back({frame.depth.timestamp, *pose});
    }
    return poses;
  }

  std::optional<ImageHeader> ReadColorHeader(
      const std::string& path) const override {
    return ImageHeader{FileOf(path)->cameras().color_size, 8, 3};
  }

  std::optional<ImageHeader> ReadDepthHeader(
      const std::string& path) const override {
    return ImageHeader{FileOf(path)->cameras().depth_size, 16, 1};
  }

  cv::Mat ReadColor(const std::string& path) const override {
    return FileOf(path)->ReadColor(IndexOf(path));
  }

  cv::Mat ReadDepth(const std::string& path) const override {
    return FileOf(path)->ReadDepth(IndexOf(path));
  }

 private:
  /// FindFrames() made the names.
  static int IndexOf(const std::string& path) {
    return std::stoi(fs::path(path).stem().string());
  }
  std::shared_ptr<const SensFile> FileOf(const std::string& path) const {
    return files_.At(fs::path(path).parent_path().string());
  }

  mutable OpenFiles<SensFile> files_;
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeSensFormat() {
  return std::make_unique<SensFormat>();
}

}  // namespace splitfusion
