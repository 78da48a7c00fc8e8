#ifndef SPLITFUSION_LIB_SEGMENTATION_RECORDING_SEGMENTER_H_
#define SPLITFUSION_LIB_SEGMENTATION_RECORDING_SEGMENTER_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/mask_folder_writer.h"
#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Passes on the masks of another segmenter and writes them into a folder, so
/// that MaskFolderSegmenter gives the same ones again.
class RecordingSegmenter : public Segmenter {
 public:
  /// The folder is made with the first frame. `settings`: see
  /// MaskFolderWriter.
  RecordingSegmenter(std::unique_ptr<Segmenter> source,
                     const std::string& folder,
                     const std::map<std::string, std::string>& settings);

  /// @throw InputError if a file cannot be written, or as the source does.
  std::vector<InstanceMask> Segment(const Frame& frame) override;

  /// Writes nothing.
  ///
  /// @throw InputError as the source does.
  std::vector<InstanceMask> Preview(const Frame& frame) override;

 private:
  std::unique_ptr<Segmenter> source_;
  std::string folder_;
  std::map<std::string, std::string> settings_;
  std::unique_ptr<MaskFolderWriter> writer_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_RECORDING_SEGMENTER_H_
