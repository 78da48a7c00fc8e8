#include "splitfusion/lib/sequence/sequence_format.h"

#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {

std::optional<Calibration> SequenceFormat::FindCalibration(
    const std::string& folder) const {
  return splitfusion::FindCalibration(folder);
}

cv::Mat SequenceFormat::ReadColor(const std::string& path) const {
  return ReadColorImage(path);
}

cv::Mat SequenceFormat::ReadDepth(const std::string& path) const {
  return ReadDepthImage(path);
}

FormatRegistry BuiltinFormats() {
  FormatRegistry registry("format");
  registry.Register("tum", MakeTumFormat);
  registry.Register("7scenes", MakeSevenScenesFormat);
  return registry;
}

std::string ResolveFormat(const std::string& name, const std::string& folder,
                          const FormatRegistry& formats) {
  if (name != "auto") {
    formats.Check(name);
    return name;
  }
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder + ": no such folder: expected a sequence");
  }
  std::vector<std::string> known;
  for (const std::string& format : formats.names()) {
    const std::unique_ptr<SequenceFormat> made = formats.Make(format);
    if (made->Recognises(folder)) return format;
    known.push_back(format + " (" + made->Files() + ")");
  }
  throw InputError(folder + ": expected a sequence of a known format, " +
                   AnyOf(known));
}

}  // namespace splitfusion
