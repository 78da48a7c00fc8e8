#include "splitfusion/lib/sequence/paired_folders.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/numbered_files.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr double kPairTolerance = 0.02;  // Seconds.

/// Names of the images of a folder, in order of their names.
std::set<std::string> ImagesIn(const fs::path& folder) {
  static const std::set<std::string> endings = {
      ".png", ".jpg", ".jpeg", ".pgm", ".tif", ".tiff", ".exr", ".bmp"};
  std::set<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    std::string ending = entry.path().extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (endings.count(ending) > 0) {
      names.insert(entry.path().filename().string());
    }
  }
  if (!names.empty()) return names;
  throw InputError(folder.string() +
                   ": 0 images: expected png, jpg, pgm, tiff or exr");
}

bool IsDigits(const std::string& text) {
  return !text.empty() &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

/// Digits at the end of a text.
std::string LastDigits(const std::string& text) {
  return text.substr(text.find_last_not_of("0123456789") + 1);
}

/// Units in a second of an integer time stamp; 0 for a number that is none.
double UnitsOf(const std::string& digits) {
  if (digits.size() == 19) return 1e9;
  if (digits.size() == 16) return 1e6;
  return digits.size() == 13 ? 1e3 : 0;
}

/// Seconds that the name of an image says, if it does.
std::optional<double> TimeOf(const std::string& name) {
  const std::string stem = fs::path(name).stem().string();
  const std::size_t dash = stem.find('-');
  if (dash != std::string::npos && IsDigits(stem.substr(0, dash)) &&
      IsDigits(stem.substr(dash + 1))) {
    return std::stod(stem.substr(dash + 1)) / 1e6;
  }
  const std::size_t dot = stem.find('.');
  if (dot != std::string::npos && IsDigits(stem.substr(0, dot)) &&
      IsDigits(stem.substr(dot + 1))) {
    return std::stod(stem);
  }
  if (!IsDigits(stem) || UnitsOf(stem) == 0) return std::nullopt;
  return std::stod(stem) / UnitsOf(stem);
}

/// All with their times; empty if one has none.
std::vector<TimedFile> Timed(const std::set<std::string>& names) {
  std::vector<TimedFile> files;
  for (const std::string& name : names) {
    const std::optional<double> time = TimeOf(name);
    if (!time) return {};
    files.push_back({*time, name});
  }
  return files;
}

/// Names by the number at their end; empty if one has none, or two the same.
std::map<std::int64_t, std::string> ByNumber(
    const std::set<std::string>& names) {
  constexpr std::size_t kMaxDigits = 18;
  std::map<std::int64_t, std::string> numbered;
  for (const std::string& name : names) {
    const std::string digits = LastDigits(fs::path(name).stem().string());
    if (digits.empty() || digits.size() > kMaxDigits) return {};
    numbered[std::stoll(digits)] = name;
  }
  if (numbered.size() != names.size()) numbered.clear();
  return numbered;
}

std::vector<AssociatedFiles> CommonNumbers(const std::set<std::string>& color,
                                           const std::set<std::string>& depth) {
  const auto colors = ByNumber(color), depths = ByNumber(depth);
  std::vector<AssociatedFiles> frames;
  for (const auto& [number, file] : depths) {
    const auto found = colors.find(number);
    if (found == colors.end()) continue;
    const double time = static_cast<double>(number) / kNumberedFramesPerSecond;
    frames.push_back({{time, found->second}, {time, file}});
  }
  return frames;
}

std::vector<AssociatedFiles> PairNames(const std::string& sequence,
                                       const std::set<std::string>& color,
                                       const std::set<std::string>& depth) {
  const std::vector<TimedFile> colors = Timed(color), depths = Timed(depth);
  if (!colors.empty() && !depths.empty()) {
    std::vector<AssociatedFiles> frames =
        AssociateByTime(colors, depths, kPairTolerance);
    if (!frames.empty()) return frames;
  }
  std::vector<AssociatedFiles> frames = CommonNumbers(color, depth);
  if (!frames.empty()) return frames;
  if (color.size() != depth.size()) {
    throw InputError(sequence + ": " + std::to_string(color.size()) +
                     " colour and " + std::to_string(depth.size()) +
                     " depth images whose names have no number or time in "
                     "common: expected as many of both, or such names");
  }
  auto c = color.begin();
  for (const std::string& d : depth) {
    const double time =
        static_cast<double>(frames.size()) / kNumberedFramesPerSecond;
    frames.push_back({{time, *c++}, {time, d}});
  }
  return frames;
}

}  // namespace

std::vector<AssociatedFiles> PairFolders(const std::string& sequence,
                                         const std::string& color,
                                         const std::string& depth) {
  for (const std::string& folder : {color, depth}) {
    if (fs::is_directory(fs::path(sequence) / folder)) continue;
    throw InputError((fs::path(sequence) / folder).string() +
                     ": no such folder: expected images");
  }
  std::vector<AssociatedFiles> frames =
      PairNames(sequence, ImagesIn(fs::path(sequence) / color),
                ImagesIn(fs::path(sequence) / depth));
  for (AssociatedFiles& frame : frames) {
    frame.color.file = (fs::path(color) / frame.color.file).string();
    frame.depth.file = (fs::path(depth) / frame.depth.file).string();
  }
  return frames;
}

std::string FirstFolder(const std::string& sequence,
                        const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (fs::is_directory(fs::path(sequence) / name)) return name;
  }
  return "";
}

}  // namespace splitfusion
