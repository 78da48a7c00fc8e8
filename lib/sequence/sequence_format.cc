#include "splitfusion/lib/sequence/sequence_format.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration_files.h"
#include "splitfusion/lib/sequence/container_formats.h"
#include "splitfusion/lib/sequence/folder_formats.h"
#include "splitfusion/lib/sequence/image_file.h"
#include "splitfusion/lib/sequence/numbered_formats.h"
#include "splitfusion/lib/sequence/tum_formats.h"

namespace splitfusion {

std::optional<Calibration> SequenceFormat::FindCalibration(
    const std::string& sequence) const {
  std::optional<Calibration> own = splitfusion::FindCalibration(sequence);
  return own ? own : FindForeignCalibration(sequence);
}

Trajectory SequenceFormat::FindPoses(
    const std::string& sequence, const std::vector<AssociatedFiles>&) const {
  const auto file = std::filesystem::path(sequence) / "groundtruth.txt";
  if (!std::filesystem::exists(file)) return {};
  return ReadTumPoses(file.string());
}

std::optional<ImageHeader> SequenceFormat::ReadColorHeader(
    const std::string& path) const {
  return ReadImageHeader(path);
}

std::optional<ImageHeader> SequenceFormat::ReadDepthHeader(
    const std::string& path) const {
  return splitfusion::ReadDepthHeader(path);
}

cv::Mat SequenceFormat::ReadColor(const std::string& path) const {
  return ReadColorImage(path);
}

cv::Mat SequenceFormat::ReadDepth(const std::string& path) const {
  return ReadDepthImage(path);
}

FormatRegistry BuiltinFormats() {
  // The more particular ones first: "auto" takes the first that fits.
  FormatRegistry registry("format");
  registry.Register("bonn", MakeBonnFormat);
  registry.Register("icl_nuim", MakeIclNuimFormat);
  registry.Register("tum", MakeTumFormat);
  registry.Register("bundlefusion", MakeBundleFusionFormat);
  registry.Register("volumedeform", MakeVolumeDeformFormat);
  registry.Register("7scenes", MakeSevenScenesFormat);
  registry.Register("scannet", MakeScanNetFormat);
  registry.Register("deepdeform", MakeDeepDeformFormat);
  registry.Register("redwood", MakeRedwoodFormat);
  registry.Register("sens", MakeSensFormat);
  registry.Register("rosbag", MakeRosBagFormat);
  return registry;
}

std::string ResolveFormat(const std::string& name, const std::string& sequence,
                          const FormatRegistry& formats) {
  if (name != "auto") {
    formats.Check(name);
    return name;
  }
  std::error_code error;
  if (!std::filesystem::exists(sequence, error)) {
    throw InputError(sequence +
                     ": no such folder or file: expected a sequence");
  }
  std::vector<std::string> known;
  for (const std::string& format : formats.names()) {
    const std::unique_ptr<SequenceFormat> made = formats.Make(format);
    if (made->Recognises(sequence)) return format;
    known.push_back(format + " (" + made->Files() + ")");
  }
  throw InputError(sequence + ": expected a sequence of a known format, " +
                   AnyOf(known));
}

}  // namespace splitfusion
