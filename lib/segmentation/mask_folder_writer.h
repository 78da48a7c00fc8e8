#ifndef SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_WRITER_H_
#define SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_WRITER_H_

#include <map>
#include <set>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Setting of masks that were made of images without lens distortion: the
/// LensDistortion::Text() of the lens that had been taken out of them.
inline constexpr char kLensSetting[] = "lens";

/// Writes the masks of frame after frame into a folder which
/// MaskFolderSegmenter reads:
///  - `STEM.png`: label image, 16 bit, pixel = index of the detection, 0 =
///    none; where instances overlap, the one with the better score. One for
///    every frame, also if nothing was detected in it.
///  - `detections.jsonl`: one detection a line (DetectionLine).
///  - `overlaps/STEM_INDEX.png`: the whole mask, 0 or 255, of every instance
///    that is partly covered by another; its line names it.
///  - `segmentation.json`: the settings that the masks depend on.
///  - `written.jsonl`: path and size of every image that was written.
///
/// Every image is written under another name first, and the label image of a
/// frame last: a frame that has it is complete, and a writer that is opened on
/// the folder again goes on after it.
class MaskFolderWriter {
 public:
  /// Opens a folder, new or begun. `settings`: what the masks depend on.
  ///
  /// @throw InputError if the folder was begun with other settings, or holds
  ///     images of another origin, or cannot be written.
  MaskFolderWriter(const std::string& folder,
                   const std::map<std::string, std::string>& settings);

  /// True if the masks of this frame are there.
  bool Has(const std::string& stem) const { return done_.count(stem) > 0; }

  /// Number of frames that are there.
  int size() const { return static_cast<int>(done_.size()); }

  /// Adds the masks of one frame; `instances`: best score first.
  ///
  /// @throw InputError if a file cannot be written.
  void Write(const Frame& frame, const std::vector<InstanceMask>& instances);

 private:
  void FindCompleteFrames();
  void RepairList() const;
  void AppendLines(const std::string& file, const std::string& text) const;
  void AddImage(const std::string& name, const cv::Mat& image) const;

  std::string folder_;
  std::set<std::string> done_;
};

/// kLensSetting of the masks of a folder; empty if they are those of images as
/// they are, or of another program.
///
/// @throw InputError if the settings are broken.
std::string LensOfMasks(const std::string& folder);

/// Removes what a MaskFolderWriter left in a folder, and nothing else: images
/// of others, or changed since, stay. A folder that none has written is left as
/// it is.
///
/// @throw InputError if the folder does not list its images, or a file cannot
///     be deleted.
void ClearMaskFolder(const std::string& folder);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_MASK_FOLDER_WRITER_H_
