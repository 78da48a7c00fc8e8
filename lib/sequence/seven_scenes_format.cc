#include <filesystem>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/calibration.h"
#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr char kPrefix[] = "frame-";
constexpr char kColor[] = ".color.png";
constexpr char kDepth[] = ".depth.png";
constexpr double kFramesPerSecond = 30;
constexpr int kNoMeasurement = 65535;

/// The six digits of `frame-000000.color.png`; empty for another name.
std::string DigitsOf(const std::string& name) {
  constexpr std::size_t kBegin = sizeof(kPrefix) - 1, kDigits = 6;
  if (name.rfind(kPrefix, 0) != 0 || name.size() <= kBegin + kDigits ||
      name.substr(kBegin + kDigits) != kColor) {
    return "";
  }
  const std::string digits = name.substr(kBegin, kDigits);
  const bool good = digits.find_first_not_of("0123456789") == std::string::npos;
  return good ? digits : "";
}

/// Of all colour images, in order.
std::set<std::string> FindDigits(const std::string& folder) {
  std::set<std::string> found;
  if (!fs::is_directory(folder)) return found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    found.insert(DigitsOf(entry.path().filename().string()));
  }
  found.erase("");
  return found;
}

class SevenScenesFormat : public SequenceFormat {
 public:
  std::string Files() const override {
    return "frame-000000.color.png, frame-000000.depth.png, ...";
  }

  bool Recognises(const std::string& folder) const override {
    return !FindDigits(folder).empty();
  }

  std::vector<AssociatedFiles> FindFrames(
      const std::string& folder) const override {
    std::vector<AssociatedFiles> frames;
    for (const std::string& digits : FindDigits(folder)) {
      const double time = std::stoi(digits) / kFramesPerSecond;
      frames.push_back({{time, kPrefix + digits + kColor},
                        {time, kPrefix + digits + kDepth}});
    }
    if (frames.empty())
      throw InputError(folder + ": 0 frames: expected " + Files());
    return frames;
  }

  std::optional<Calibration> FindCalibration(
      const std::string& folder) const override {
    const auto found = SequenceFormat::FindCalibration(folder);
    return found ? found : Calibration{{640, 480, 585, 585, 320, 240}, 1000};
  }

  cv::Mat ReadDepth(const std::string& path) const override {
    cv::Mat depth = SequenceFormat::ReadDepth(path);
    depth.setTo(0, depth == kNoMeasurement);
    return depth;
  }
};

}  // namespace

std::unique_ptr<SequenceFormat> MakeSevenScenesFormat() {
  return std::make_unique<SevenScenesFormat>();
}

}  // namespace splitfusion
