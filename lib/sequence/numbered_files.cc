#include "splitfusion/lib/sequence/numbered_files.h"

#include <filesystem>
#include <optional>
#include <utility>

#include "splitfusion/lib/sequence/calibration_files.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

bool EndsIn(const std::string& text, const std::string& ending) {
  return text.size() >= ending.size() &&
         text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

/// The number between `prefix` and `ending`; none if it is another name.
std::optional<std::int64_t> NumberIn(const std::string& name,
                                     const std::string& prefix,
                                     const std::string& ending) {
  constexpr std::size_t kMaxDigits = 18;
  if (name.size() <= prefix.size() + ending.size() ||
      name.rfind(prefix, 0) != 0 || !EndsIn(name, ending)) {
    return std::nullopt;
  }
  const std::string digits =
      name.substr(prefix.size(), name.size() - prefix.size() - ending.size());
  if (digits.find_first_not_of("0123456789") != std::string::npos ||
      digits.size() > kMaxDigits) {
    return std::nullopt;
  }
  return std::stoll(digits);
}

}  // namespace

std::map<std::int64_t, std::string> NumberedFiles(
    const std::string& folder, const std::string& prefix,
    const std::vector<std::string>& endings) {
  std::map<std::int64_t, std::string> files;
  if (!fs::is_directory(folder)) return files;
  for (const std::string& ending : endings) {
    std::map<std::int64_t, std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      const auto number = NumberIn(name, prefix, ending);
      if (number) found.emplace(*number, name);
    }
    files.merge(found);
  }
  return files;
}

std::vector<AssociatedFiles> PairByNumber(
    const std::map<std::int64_t, std::string>& color,
    const std::map<std::int64_t, std::string>& depth,
    const std::function<std::string(const std::string&)>& color_name,
    const std::function<std::string(const std::string&)>& depth_name) {
  std::map<std::int64_t, AssociatedFiles> frames;
  for (const auto& [number, file] : color) {
    frames[number].color.file = file;
    frames[number].depth.file = depth_name(file);
  }
  for (const auto& [number, file] : depth) {
    AssociatedFiles& frame = frames[number];
    frame.depth.file = file;
    if (frame.color.file.empty()) frame.color.file = color_name(file);
  }
  std::vector<AssociatedFiles> list;
  for (auto& [number, frame] : frames) {
    const double time = static_cast<double>(number) / kNumberedFramesPerSecond;
    frame.color.timestamp = frame.depth.timestamp = time;
    list.push_back(std::move(frame));
  }
  return list;
}

Trajectory ReadPoseFiles(
    const std::vector<AssociatedFiles>& frames,
    const std::function<std::string(const std::string&)>& pose_name) {
  Trajectory poses;
  for (const AssociatedFiles& frame : frames) {
    const std::string path = pose_name(frame.depth.file);
    if (!fs::exists(path)) continue;
    const std::optional<Rigid3d> pose =
        RigidMotion(path, ReadMatrix(path, 4, 4));
    if (pose) poses.push_back({frame.depth.timestamp, *pose});
  }
  return poses;
}

}  // namespace splitfusion
