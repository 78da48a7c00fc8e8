#include "splitfusion/lib/segmentation/mask_folder_writer.h"

#include <filesystem>
#include <fstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/make_folder.h"
#include "splitfusion/lib/base/owned_files.h"
#include "splitfusion/lib/segmentation/detection_list.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Settings = std::map<std::string, std::string>;

constexpr char kSettingsFile[] = "segmentation.json";
constexpr char kOverlapFolder[] = "overlaps";
constexpr char kWrittenFile[] = "written.jsonl";

/// Stems of the label images in a folder; half-written ones, whose name begins
/// with a dot, left out.
std::set<std::string> LabelStems(const fs::path& folder) {
  std::set<std::string> stems;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    if (entry.path().extension() == ".png" && stem[0] != '.') {
      stems.insert(stem);
    }
  }
  return stems;
}

std::string WrittenLine(const OwnedFile& file) {
  return nlohmann::json{{"path", file.path}, {"bytes", file.bytes}}.dump() +
         "\n";
}

/// The images that were written into a folder; a line cut short by a kill, and
/// those that are not there any more or have changed, left out.
OwnedFileList WrittenImages(const fs::path& folder) {
  OwnedFileList files;
  std::ifstream stream(folder / kWrittenFile);
  for (std::string line; std::getline(stream, line);) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    OwnedFile file;
    try {
      file = {json.at("path").get<std::string>(),
              json.at("bytes").get<std::uintmax_t>()};
    } catch (const nlohmann::json::exception&) {
      continue;
    }
    if (IsAsWritten(folder.string(), file)) files.push_back(file);
  }
  return files;
}

Settings ReadSettings(const fs::path& path) {
  try {
    auto json = ReadVersionedOrNull(path.string());
    json.erase("format_version");
    return json.get<Settings>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(path.string() +
                     ": expected the settings of a segmentation, a JSON "
                     "object of texts");
  }
}

/// @throw InputError on the first difference.
void CheckEqual(const fs::path& path, const Settings& found,
                const Settings& wanted) {
  for (const auto& [name, value] : wanted) {
    const auto before = found.find(name);
    if (before != found.end() && before->second == value) continue;
    const bool is_long = value.find('\n') != std::string::npos;
    throw InputError(path.string() + ": masks were made with another " + name +
                     (is_long || before == found.end()
                          ? std::string()
                          : " (" + before->second + ", now " + value + ")") +
                     ": expected the same, another folder, or --overwrite");
  }
}

/// Pixels of instance `i` that a better one has as well.
bool IsCovered(const std::vector<InstanceMask>& instances, std::size_t i,
               const cv::Mat& labels) {
  return cv::countNonZero(instances[i].mask) !=
         cv::countNonZero(labels == static_cast<int>(i + 1));
}

/// Painted from the last to the first, so that the best lies on top.
cv::Mat LabelImageOf(const std::vector<InstanceMask>& instances,
                     cv::Size size) {
  cv::Mat labels = cv::Mat::zeros(size, CV_16UC1);
  for (std::size_t i = instances.size(); i-- > 0;) {
    labels.setTo(static_cast<double>(i + 1), instances[i].mask);
  }
  return labels;
}

}  // namespace

MaskFolderWriter::MaskFolderWriter(const std::string& folder,
                                   const Settings& settings)
    : folder_(folder) {
  const fs::path path = fs::path(folder) / kSettingsFile;
  MakeFolder(folder);
  if (fs::exists(path)) {
    CheckEqual(path, ReadSettings(path), settings);
  } else if (!LabelStems(folder).empty()) {
    throw InputError(folder + ": holds png files without " + kSettingsFile +
                     ": expected a new folder, or one of an earlier run");
  }
  WriteJson(path.string(), Versioned(nlohmann::json(settings)), 1);
  RepairList();
  FindCompleteFrames();
}

/// A line cut short by a kill would swallow the next one.
void MaskFolderWriter::RepairList() const {
  const fs::path list = fs::path(folder_) / kWrittenFile;
  if (!fs::exists(list)) return;
  const OwnedFileList written = WrittenImages(folder_);
  WriteFileAtomically(list.string(), [&](std::ostream& out) {
    for (const OwnedFile& file : written) out << WrittenLine(file);
  });
}

void MaskFolderWriter::FindCompleteFrames() {
  const fs::path path = fs::path(folder_) / kDetectionListFile;
  std::string kept;
  if (fs::exists(path)) {
    done_ = LabelStems(folder_);
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
      const auto json = nlohmann::json::parse(line, nullptr, false);
      const bool is_whole = json.is_object() && json.contains("stem");
      if (is_whole && Has(json["stem"])) kept += line + "\n";
    }
  }
  WriteFileAtomically(path.string(), [&](std::ostream& out) { out << kept; });
}

void MaskFolderWriter::AppendLines(const std::string& file,
                                   const std::string& text) const {
  const fs::path path = fs::path(folder_) / file;
  std::ofstream stream(path, std::ios::binary | std::ios::app);
  stream << text << std::flush;
  if (!stream) {
    throw InputError(path.string() + ": cannot be written (disk full?)");
  }
}

/// Listed before it gets its name: an image that is there without being listed
/// was written by another program.
void MaskFolderWriter::AddImage(const std::string& name,
                                const cv::Mat& image) const {
  const std::string path = (fs::path(folder_) / name).string();
  const std::string bytes = EncodeImage(path, image);
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << bytes << std::flush;
    if (!out) return;  // The caller says so.
    AppendLines(kWrittenFile, WrittenLine({name, bytes.size()}));
  });
}

void MaskFolderWriter::Write(const Frame& frame,
                             const std::vector<InstanceMask>& instances) {
  const cv::Mat labels = LabelImageOf(instances, frame.color.size());
  std::string lines;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    Detection detection{static_cast<int>(i + 1), instances[i].class_name,
                        instances[i].score, instances[i].box};
    if (IsCovered(instances, i, labels)) {
      detection.mask = std::string(kOverlapFolder) + "/" + frame.stem + "_" +
                       std::to_string(detection.index) + ".png";
      AddImage(detection.mask, instances[i].mask);
    }
    lines += DetectionLine(frame.index, frame.stem, detection) + "\n";
  }
  AppendLines(kDetectionListFile, lines);
  AddImage(frame.stem + ".png", labels);
  done_.insert(frame.stem);
}

std::string LensOfMasks(const std::string& folder) {
  const fs::path path = fs::path(folder) / kSettingsFile;
  if (!fs::exists(path)) return "";
  const Settings settings = ReadSettings(path);
  const auto found = settings.find(kLensSetting);
  return found == settings.end() ? "" : found->second;
}

void ClearMaskFolder(const std::string& folder) {
  const fs::path root(folder);
  if (!fs::exists(root / kSettingsFile)) return;
  if (!fs::exists(root / kWrittenFile) && !LabelStems(root).empty()) {
    throw InputError(folder + ": not overwritten, for it does not say which " +
                     "images sf_segment wrote (no " + kWrittenFile + ")");
  }
  RemoveOwnedFiles(folder, WrittenImages(root));
  fs::remove(root / kDetectionListFile);
  fs::remove(root / kWrittenFile);
  fs::remove(root / kSettingsFile);
}

}  // namespace splitfusion
