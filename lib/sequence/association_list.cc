#include "splitfusion/lib/sequence/association_list.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <tuple>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

bool Parse(std::istream& words, TimedFile* entry) {
  return (words >> entry->timestamp >> entry->file) &&
         std::isfinite(entry->timestamp);
}

bool IsDepthName(const std::string& file) {
  return file.find("depth") != std::string::npos;
}

bool IsDepthImage(const fs::path& path) {
  try {
    return ReadDepthImage(path.string()).type() == CV_16UC1;
  } catch (const InputError&) {
    return false;  // A broken file is reported when it is read.
  }
}

/// True if the second column of the pairs is the colour.
bool ColumnsAreSwapped(const std::string& folder, const AssociatedFiles& pair) {
  const bool first_named = IsDepthName(pair.color.file);
  if (first_named != IsDepthName(pair.depth.file)) return first_named;
  return IsDepthImage(fs::path(folder) / pair.color.file);
}

/// Index range of the entries (in order of time) within `tolerance` of `t`.
std::pair<int, int> Window(const std::vector<TimedFile>& sorted, double t,
                           double tolerance) {
  const auto before = [](const TimedFile& a, double b) {
    return a.timestamp < b;
  };
  const auto begin =
      std::lower_bound(sorted.begin(), sorted.end(), t - tolerance, before);
  auto end = begin;
  while (end != sorted.end() && end->timestamp <= t + tolerance) ++end;
  return {static_cast<int>(begin - sorted.begin()),
          static_cast<int>(end - sorted.begin())};
}

std::vector<TimedFile> SortedByTime(std::vector<TimedFile> files) {
  std::stable_sort(files.begin(), files.end(),
                   [](const TimedFile& a, const TimedFile& b) {
                     return a.timestamp < b.timestamp;
                   });
  return files;
}

}  // namespace

std::vector<TimedFile> ReadTimedFiles(const std::string& path) {
  std::vector<TimedFile> files;
  for (const TextLine& line : ReadTextLines(path)) {
    std::istringstream words(line.text);
    if (!Parse(words, &files.emplace_back())) line.Refuse("'timestamp file'");
  }
  return files;
}

std::vector<AssociatedFiles> ReadAssociations(const std::string& folder) {
  const std::string path = (fs::path(folder) / "associations.txt").string();
  std::vector<AssociatedFiles> pairs;
  for (const TextLine& line : ReadTextLines(path)) {
    std::istringstream words(line.text);
    AssociatedFiles& pair = pairs.emplace_back();
    if (!Parse(words, &pair.color) || !Parse(words, &pair.depth)) {
      line.Refuse("'timestamp file timestamp file'");
    }
  }
  if (!pairs.empty() && ColumnsAreSwapped(folder, pairs.front())) {
    for (AssociatedFiles& pair : pairs) std::swap(pair.color, pair.depth);
  }
  return pairs;
}

std::vector<AssociatedFiles> AssociateByTime(
    const std::vector<TimedFile>& color, const std::vector<TimedFile>& depth,
    double tolerance) {
  const std::vector<TimedFile> colors = SortedByTime(color);
  const std::vector<TimedFile> depths = SortedByTime(depth);
  std::vector<std::tuple<double, int, int>> candidates;
  for (int d = 0; d < static_cast<int>(depths.size()); ++d) {
    const double t = depths[d].timestamp;
    const auto [begin, end] = Window(colors, t, tolerance);
    for (int c = begin; c < end; ++c) {
      candidates.emplace_back(std::abs(colors[c].timestamp - t), d, c);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<int> color_of(depths.size(), -1);
  std::vector<bool> taken(colors.size(), false);
  for (const auto& [difference, d, c] : candidates) {
    if (color_of[d] >= 0 || taken[c]) continue;
    color_of[d] = c;
    taken[c] = true;
  }
  std::vector<AssociatedFiles> pairs;
  for (std::size_t d = 0; d < depths.size(); ++d) {
    if (color_of[d] >= 0) pairs.push_back({colors[color_of[d]], depths[d]});
  }
  return pairs;
}

std::vector<AssociatedFiles> FindAssociations(const std::string& folder,
                                              double tolerance) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder +
                     ": no such folder: expected a sequence in TUM "
                     "layout");
  }
  const fs::path root(folder);
  if (fs::exists(root / "associations.txt")) {
    std::vector<AssociatedFiles> pairs = ReadAssociations(folder);
    if (!pairs.empty()) return pairs;
    throw InputError((root / "associations.txt").string() +
                     ": 0 frames: expected at least one line");
  }
  const std::vector<TimedFile> color =
      ReadTimedFiles((root / "rgb.txt").string());
  const std::vector<TimedFile> depth =
      ReadTimedFiles((root / "depth.txt").string());
  std::vector<AssociatedFiles> pairs = AssociateByTime(color, depth, tolerance);
  if (!pairs.empty()) return pairs;
  throw InputError(folder + ": 0 frames: none of " +
                   std::to_string(depth.size()) + " depth and " +
                   std::to_string(color.size()) + " colour images are within " +
                   std::to_string(tolerance) + " s of each other");
}

}  // namespace splitfusion
