#include "splitfusion/lib/experiment/sequence_list.h"

#include <algorithm>
#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/sequence/sequence_format.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

bool HasGroundTruth(const fs::path& folder) {
  return fs::is_regular_file(folder / "groundtruth.txt");
}

std::string FindGroundTruth(const std::string& ground_truth,
                            const fs::path& sequence, const std::string& name,
                            const fs::path& root) {
  if (ground_truth == "none" || ground_truth.empty()) return "";
  std::vector<fs::path> candidates = {sequence / "gt", sequence};
  if (ground_truth != "auto") {
    const fs::path folder = root / ground_truth;
    CheckOption(fs::is_directory(folder), "ground_truth", ground_truth,
                "auto, none or a folder");
    candidates = {folder, folder / name, folder / name / "gt"};
  }
  for (const fs::path& folder : candidates) {
    if (HasGroundTruth(folder)) return folder.string();
  }
  return "";
}

/// Whether a file is a sequence itself, and no list of them.
bool IsSequenceFile(const std::string& path) {
  const FormatRegistry formats = BuiltinFormats();
  const std::vector<std::string> names = formats.names();
  return std::any_of(names.begin(), names.end(), [&](const auto& name) {
    return formats.Make(name)->Recognises(path);
  });
}

}  // namespace

SequenceEntry MakeSequence(const std::string& folder,
                           const std::string& ground_truth,
                           const std::string& root) {
  const fs::path path =
      fs::absolute(fs::path(root) / folder).lexically_normal();
  if (!fs::is_directory(path) && !fs::is_regular_file(path)) {
    throw InputError(folder +
                     ": not found; expected a sequence folder, or its file");
  }
  const fs::path whole = path.has_filename() ? path : path.parent_path();
  SequenceEntry entry;
  entry.name = whole.filename().string();
  entry.folder = whole.string();
  entry.ground_truth = FindGroundTruth(ground_truth, whole, entry.name, root);
  return entry;
}

std::vector<SequenceEntry> ReadSequences(const std::string& text,
                                         const std::string& ground_truth) {
  const fs::path here = fs::current_path();
  const std::string truth =
      ground_truth == "auto" || ground_truth == "none" || ground_truth.empty()
          ? ground_truth
          : (here / ground_truth).string();
  std::vector<SequenceEntry> sequences;
  for (const std::string& quoted : SplitOutsideQuotes(text, ',')) {
    const std::string part = Unquoted(quoted);
    if (!fs::is_regular_file(part) || IsSequenceFile(part)) {
      sequences.push_back(MakeSequence(part, truth, here.string()));
      continue;
    }
    const fs::path list = fs::absolute(part);
    for (const TextLine& line : ReadTextLines(list, /*cut_comments=*/true)) {
      sequences.push_back(
          MakeSequence(line.text, truth, list.parent_path().string()));
    }
  }
  return sequences;
}

}  // namespace splitfusion
