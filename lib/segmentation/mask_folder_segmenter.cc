#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <set>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

/// Names of the files in `folder` with `extension`, in order.
std::vector<std::string> ListFiles(const std::string& folder,
                                   const std::string& extension) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == extension) {
      names.push_back(entry.path().filename().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

bool ListsDetections(const std::string& folder) {
  const std::string classes = kClassListExtension;
  const std::vector<std::string> texts = ListFiles(folder, ".txt");
  return fs::exists(fs::path(folder) / kDetectionListFile) ||
         !ListFiles(folder, ".json").empty() ||
         std::any_of(texts.begin(), texts.end(), [&](const std::string& name) {
           return name.size() > classes.size() &&
                  name.compare(name.size() - classes.size(), classes.size(),
                               classes) == 0;
         });
}

std::vector<Detection> DetectionsOfValues(const cv::Mat& labels,
                                          const std::string& unnamed_class) {
  std::set<int> values(labels.begin<std::uint16_t>(),
                       labels.end<std::uint16_t>());
  values.erase(0);
  std::vector<Detection> detections;
  for (const int value : values) {
    detections.push_back({value, unnamed_class, 1.0});
  }
  return detections;
}

/// Class of `STEM_CLASS.png` or `STEM_CLASS_NUMBER.png`; `_` is a space.
std::string ClassOfFile(const std::string& name, const std::string& prefix,
                        const std::string& unnamed_class) {
  std::string text = fs::path(name.substr(prefix.size())).stem().string();
  std::replace(text.begin(), text.end(), '_', ' ');
  const std::size_t last = text.find_last_not_of("0123456789");
  if (last == std::string::npos) return unnamed_class;
  if (text[last] == ' ') text.erase(last);
  return text;
}

/// @throw InputError unless a mask has the size of its frame.
void CheckSize(const std::string& path, const cv::Size& size,
               const cv::Size& expected) {
  if (size == expected) return;
  throw InputError(path + ": mask of " + ToString(size) + ": expected " +
                   ToString(expected) + ", the size of the frame");
}

/// The same by its header.
void CheckMaskFile(const std::string& path, const cv::Size& expected) {
  const std::optional<ImageHeader> header = ReadLabelHeader(path);
  if (header) CheckSize(path, header->size, expected);
}

cv::Mat ReadMask(const std::string& path, const Frame& frame) {
  CheckMaskFile(path, frame.color.size());
  cv::Mat labels = ReadLabelImage(path);
  CheckSize(path, labels.size(), frame.color.size());
  return labels;
}

void AddInstance(const cv::Mat& mask, const Detection& detection, int identity,
                 std::vector<InstanceMask>* instances) {
  if (cv::countNonZero(mask) == 0) return;
  instances->push_back(
      {mask, detection.class_name, detection.score, detection.box, identity});
}

}  // namespace

MaskFolderSegmenter::MaskFolderSegmenter(const std::string& folder,
                                         const std::string& unnamed_class,
                                         bool given_identities)
    : folder_(folder),
      unnamed_class_(unnamed_class),
      given_identities_(given_identities) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder +
                     ": no such folder: expected masks, one png a "
                     "frame");
  }
  instance_files_ = ListFiles(folder, ".png");
  if (instance_files_.empty()) {
    throw InputError(folder +
                     ": 0 png files: expected masks named after the "
                     "depth or colour files");
  }
  instance_files_.erase(
      std::remove_if(instance_files_.begin(), instance_files_.end(),
                     [](const std::string& name) {
                       return name.find('_') == std::string::npos;
                     }),
      instance_files_.end());
  const std::string list = (fs::path(folder) / kDetectionListFile).string();
  if (fs::exists(list)) lists_ = ReadDetectionLists(list, unnamed_class);
}

std::vector<Detection> MaskFolderSegmenter::DetectionsOf(
    const std::string& stem, const cv::Mat& labels) const {
  const std::string own = (fs::path(folder_) / (stem + ".json")).string();
  if (fs::exists(own)) return ReadDetections(own, unnamed_class_);
  const std::string classes =
      (fs::path(folder_) / (stem + kClassListExtension)).string();
  if (fs::exists(classes)) return ReadClassList(classes);
  if (!lists_) return DetectionsOfValues(labels, unnamed_class_);
  const auto found = lists_->find(stem);
  return found == lists_->end() ? std::vector<Detection>() : found->second;
}

std::vector<std::string> MaskFolderSegmenter::InstanceFiles(
    const std::string& stem) const {
  const std::string prefix = stem + "_";
  std::vector<std::string> names;
  std::copy_if(instance_files_.begin(), instance_files_.end(),
               std::back_inserter(names), [&](const std::string& name) {
                 return name.compare(0, prefix.size(), prefix) == 0;
               });
  return names;
}

bool MaskFolderSegmenter::Has(const std::string& stem) const {
  return fs::exists(fs::path(folder_) / (stem + ".png")) ||
         !InstanceFiles(stem).empty();
}

void MaskFolderSegmenter::CheckFiles(const std::string& stem,
                                     const cv::Size& size) const {
  const fs::path root(folder_);
  const std::string label_path = (root / (stem + ".png")).string();
  if (fs::exists(label_path)) {
    CheckMaskFile(label_path, size);
    for (const Detection& detection : DetectionsOf(stem, cv::Mat())) {
      if (detection.mask.empty()) continue;
      CheckMaskFile((root / detection.mask).string(), size);
    }
  }
  for (const std::string& name : InstanceFiles(stem)) {
    CheckMaskFile((root / name).string(), size);
  }
}

std::set<std::string> MaskFolderSegmenter::ClassesOf(
    const std::string& stem) const {
  std::set<std::string> classes;
  if (fs::exists(fs::path(folder_) / (stem + ".png"))) {
    for (const Detection& d : DetectionsOf(stem, cv::Mat())) {
      classes.insert(d.class_name);
    }
  }
  for (const std::string& name : InstanceFiles(stem)) {
    classes.insert(ClassOfFile(name, stem + "_", unnamed_class_));
  }
  return classes;
}

std::string MaskFolderSegmenter::StemOf(const Frame& frame) const {
  const bool by_color =
      !frame.color_stem.empty() && !Has(frame.stem) && Has(frame.color_stem);
  return by_color ? frame.color_stem : frame.stem;
}

std::vector<InstanceMask> MaskFolderSegmenter::Segment(const Frame& frame) {
  std::vector<InstanceMask> instances;
  const fs::path root(folder_);
  const std::string stem = StemOf(frame);
  const std::string label_path = (root / (stem + ".png")).string();
  if (fs::exists(label_path)) {
    const cv::Mat labels = ReadMask(label_path, frame);
    for (const Detection& detection : DetectionsOf(stem, labels)) {
      const cv::Mat mask =
          detection.mask.empty()
              ? cv::Mat(labels == detection.index)
              : cv::Mat(ReadMask((root / detection.mask).string(), frame) != 0);
      AddInstance(mask, detection, given_identities_ ? detection.index : 0,
                  &instances);
    }
  }
  for (const std::string& name : InstanceFiles(stem)) {
    AddInstance(ReadMask((root / name).string(), frame) != 0,
                {1, ClassOfFile(name, stem + "_", unnamed_class_), 1.0}, 0,
                &instances);
  }
  std::stable_sort(instances.begin(), instances.end(),
                   [](const InstanceMask& a, const InstanceMask& b) {
                     return a.score > b.score;
                   });
  return instances;
}

std::string FindMaskFolder(const std::string& sequence) {
  const fs::path detected = fs::path(sequence) / "masks_noisy";
  if (fs::is_directory(detected) && ListsDetections(detected.string())) {
    return detected.string();
  }
  const fs::path plain = fs::path(sequence) / "mask";
  return fs::is_directory(plain) ? plain.string() : "";
}

}  // namespace splitfusion
