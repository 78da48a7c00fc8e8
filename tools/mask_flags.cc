#include "mask_flags.h"

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "network_flags.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/segmentation/class_names.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/segmentation/mask_folder_writer.h"
#include "splitfusion/lib/segmentation/recording_segmenter.h"
#include "splitfusion/lib/segmentation/undistorting_segmenter.h"

DEFINE_string(masks, "auto",
              "A folder, none, or auto (--model, or beside it).");
DEFINE_string(mask_kind, "non_rigid",
              "Masks without classes are: non_rigid or rigid.");
DEFINE_string(mask_identities, "",
              "given: the index of a mask is its instance's.");
DEFINE_string(labels, "", "File with lines `class, rigid|non_rigid`.");
DECLARE_string(class_names);
DECLARE_string(sequence);

namespace splitfusion {
namespace {

using Classes = std::set<std::string>;

/// Lens of the colour files.
const LensDistortion& ColorLens(const ImageFolderReader& reader) {
  const Calibration& calibration = reader.calibration();
  return calibration.color ? calibration.color_lens : calibration.lens;
}

/// The network of the flags; its masks are kept in the run directory. They are
/// of images without lens distortion.
std::shared_ptr<Segmenter> MakeNetworkSegmenter(const ImageFolderReader& reader,
                                                const std::string& run) {
  CheckOption(FLAGS_masks == "auto", "masks", FLAGS_masks,
              "auto with --model (or an empty --model= to read masks)");
  std::unique_ptr<NetworkSegmenter> network = NetworkFromFlags();
  std::map<std::string, std::string> settings = network->Settings();
  const LensDistortion& lens = ColorLens(reader);
  if (!lens.IsNone()) settings[kLensSetting] = lens.Text();
  return std::make_shared<RecordingSegmenter>(
      std::move(network), RunPaths(run).Detections(), settings);
}

/// Stems by which the masks of a frame are found; empty where there are none.
std::vector<std::string> StemsWithMasks(const ImageFolderReader& reader,
                                        const MaskFolderSegmenter& segmenter) {
  std::vector<std::string> stems;
  for (int i = 0; i < reader.size(); ++i) {
    if (segmenter.Has(reader.Stem(i))) {
      stems.push_back(reader.Stem(i));
    } else if (segmenter.Has(reader.ColorStem(i))) {
      stems.push_back(reader.ColorStem(i));
    }
  }
  return stems;
}

/// @throw InputError if no frame has a mask: names of another image do not fit.
void CheckMasksFit(const ImageFolderReader& reader,
                   std::size_t frames_with_masks, const std::string& folder) {
  const std::string frames = std::to_string(reader.size());
  if (frames_with_masks == 0) {
    throw InputError(folder + ": no mask for any of the " + frames +
                     " frames: expected names by the depth image, such as " +
                     reader.Stem(0) + ".png, or by the colour image");
  }
  if (frames_with_masks == static_cast<std::size_t>(reader.size())) return;
  LOG(WARNING) << folder << ": masks of " << frames_with_masks << " of "
               << frames << " frames; in the others nothing is detected";
}

/// Warns of names in `groups` (--merge_touching) that neither the table nor
/// `known` has.
void WarnOfUnknownClasses(const std::string& groups, const LabelTable& table,
                          const Classes& known) {
  Classes named;
  for (const MergeGroup& group : ParseMergeGroups(groups)) {
    named.insert(group.body);
    named.insert(group.held.begin(), group.held.end());
  }
  std::string unknown;
  for (const std::string& name : named) {
    if (table.Knows(name) || known.count(name) > 0) continue;
    unknown += (unknown.empty() ? "'" : ", '") + name + "'";
  }
  if (unknown.empty()) return;
  LOG(WARNING) << "--merge_touching: no label table, network or mask knows "
               << unknown;
}

/// Masks of a folder for images without lens distortion.
std::shared_ptr<Segmenter> WithoutLens(
    const ImageFolderReader& reader, const std::string& folder,
    const std::shared_ptr<Segmenter>& segmenter) {
  const auto undistortion = reader.color_undistortion();
  if (!undistortion) return segmenter;
  const std::string made = LensOfMasks(folder);
  const std::string lens = ColorLens(reader).Text();
  if (made == lens) return segmenter;
  if (!made.empty()) {
    throw InputError(folder + ": masks of images without the lens '" + made +
                     "': expected that of the sequence, '" + lens + "'");
  }
  return std::make_shared<UndistortingSegmenter>(segmenter, undistortion);
}

std::shared_ptr<Segmenter> MakeFolderSegmenter(const ImageFolderReader& reader,
                                               const std::string& folder,
                                               const PipelineOptions& options) {
  CheckOption(FLAGS_mask_kind == "rigid" || FLAGS_mask_kind == "non_rigid",
              "mask_kind", FLAGS_mask_kind, "rigid or non_rigid");
  const std::string unnamed =
      FLAGS_mask_kind == "rigid" ? kUnnamedRigidClass : kUnnamedClass;
  auto segmenter = std::make_shared<MaskFolderSegmenter>(
      folder, unnamed, FLAGS_mask_identities == "given");
  const std::vector<std::string> stems = StemsWithMasks(reader, *segmenter);
  CheckMasksFit(reader, stems.size(), folder);
  for (const std::string& stem : stems) {
    segmenter->CheckFiles(stem, reader.color_size());
  }
  if (!options.split.merge_touching.empty()) {
    Classes known = {unnamed};
    for (const std::string& stem : stems) {
      known.merge(segmenter->ClassesOf(stem));
    }
    WarnOfUnknownClasses(options.split.merge_touching, LabelsFromFlags(),
                         known);
  }
  return WithoutLens(reader, folder, segmenter);
}

}  // namespace

LabelTable LabelsFromFlags() {
  return FLAGS_labels.empty() ? LabelTable()
                              : LabelTable::FromFile(FLAGS_labels);
}

std::shared_ptr<Segmenter> SegmenterFromFlags(const ImageFolderReader& reader,
                                              const PipelineOptions& options,
                                              const std::string& run) {
  CheckOption(FLAGS_mask_identities == "given" || FLAGS_mask_identities.empty(),
              "mask_identities", FLAGS_mask_identities, "given, or nothing");
  CheckOption(FLAGS_mask_identities.empty() ||
                  (FLAGS_masks != "none" && !HasNetworkFlags()),
              "mask_identities", FLAGS_mask_identities,
              "nothing, as it has no effect but with masks from files");
  if (HasNetworkFlags()) {
    std::shared_ptr<Segmenter> segmenter = MakeNetworkSegmenter(reader, run);
    Classes known;
    if (!FLAGS_class_names.empty()) {
      for (const auto& name : ReadClassNames(FLAGS_class_names)) {
        known.insert(name);
      }
    }
    WarnOfUnknownClasses(options.split.merge_touching, LabelsFromFlags(),
                         known);
    return segmenter;
  }
  if (FLAGS_masks == "none" || FLAGS_masks.empty()) return nullptr;
  if (FLAGS_masks != "auto") {
    return MakeFolderSegmenter(reader, FLAGS_masks, options);
  }
  const std::string found = FindMaskFolder(FLAGS_sequence);
  if (!found.empty()) return MakeFolderSegmenter(reader, found, options);
  if (options.split_scene) {
    LOG(WARNING) << "no masks found: neither " << FLAGS_sequence
                 << "/masks_noisy with lists of detections nor "
                 << FLAGS_sequence
                 << "/mask; only the background is reconstructed; use --masks "
                    "or --model";
  }
  return nullptr;
}

}  // namespace splitfusion
