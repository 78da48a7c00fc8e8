#ifndef SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_SEGMENTER_H_
#define SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_SEGMENTER_H_

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/detection_list.h"
#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Class of a mask without one that is to be a non-rigid surface.
inline constexpr char kUnnamedClass[] = "object";
/// Class of a mask without one that is to be a rigid surface.
inline constexpr char kUnnamedRigidClass[] = "rigid_object";

/// Masks from files, any segmenter's output. Per frame, by the stem of its
/// depth file, or of its colour file if there is none by that, one of
///  - `STEM.png`, 8 or 16 bit, pixel = index of the detection, 0 = none, with
///    `STEM.json` = [{"index", "class", "score", "bbox"}, ...]; pixels of an
///    index that the list does not name are left out;
///  - `STEM.png` with `STEM.classes.txt`, lines "INDEX CLASS";
///  - `STEM.png` in a folder with `detections.jsonl`, which lists the
///    detections of all frames, one a line: {"stem", "index", "class", "score",
///    "box", "mask"}; `mask`, if given, is the file of the whole mask where
///    other detections cover a part of it in STEM.png;
///  - `STEM.png` alone: every value above 0 is an instance without class (a
///    0/255 mask is one);
///  - `STEM_CLASS.png`, any number: one instance each, inside where not 0;
///    `_` in CLASS stands for a space, and `_NUMBER` may follow
///    or stand in its place.
/// A frame without a file has no detections; a detection without a pixel is
/// dropped.
class MaskFolderSegmenter : public Segmenter {
 public:
  /// `unnamed_class`: class of masks without one; kUnnamedClass or
  /// kUnnamedRigidClass, or any name of the label table. `given_identities`:
  /// the index of a detection, or the value of a pixel without a list, is the
  /// instance's in all frames; files of single instances give none.
  ///
  /// @throw InputError if the folder is missing or holds no png.
  explicit MaskFolderSegmenter(const std::string& folder,
                               const std::string& unnamed_class = kUnnamedClass,
                               bool given_identities = false);

  /// @throw InputError on a broken file or a mask of another size than the
  ///     frame.
  std::vector<InstanceMask> Segment(const Frame& frame) override;

  /// Whether there is a file for the frame of this stem.
  bool Has(const std::string& stem) const;

  /// Looks at the files of a stem without decoding them: that their headers can
  /// be read and are those of masks of `size`, and that the lists are whole.
  ///
  /// @throw InputError on the first that is not.
  void CheckFiles(const std::string& stem, const cv::Size& size) const;

  /// Classes that the lists and file names of this stem give; without those of
  /// pixels that no list names.
  ///
  /// @throw InputError on a broken list.
  std::set<std::string> ClassesOf(const std::string& stem) const;

 private:
  std::string StemOf(const Frame& frame) const;
  /// Instance files of this stem.
  std::vector<std::string> InstanceFiles(const std::string& stem) const;
  std::vector<Detection> DetectionsOf(const std::string& stem,
                                      const cv::Mat& labels) const;

  std::string folder_;
  std::string unnamed_class_;
  bool given_identities_;
  /// Instance files (`STEM_CLASS.png`) by file name.
  std::vector<std::string> instance_files_;
  /// Content of detections.jsonl, if there is one.
  std::optional<DetectionLists> lists_;
};

/// The masks found beside a sequence: `masks_noisy` if it holds detections
/// (a json, jsonl or classes.txt file), else `mask`, else an empty string.
std::string FindMaskFolder(const std::string& sequence);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_SEGMENTER_H_
