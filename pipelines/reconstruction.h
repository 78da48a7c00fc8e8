#ifndef SPLITFUSION_PIPELINES_RECONSTRUCTION_H_
#define SPLITFUSION_PIPELINES_RECONSTRUCTION_H_

#include <functional>
#include <memory>
#include <string>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {

/// Frames in and surfaces out: what a run computes with.
struct Reconstruction {
  /// What makes the masks of a sequence; null if nothing does.
  using SegmenterMaker =
      std::function<std::shared_ptr<Segmenter>(const ImageFolderReader&)>;

  /// Looks at all images first, unless bad ones may be skipped. Unless the
  /// options tell where the colour camera is, it is estimated, and used if the
  /// images are certainly not registered; likewise, whether rows were exposed
  /// one after the other, of what `labels` do not call non-rigid.
  ///
  /// @throw InputError if the sequence or an option cannot be used, or names
  ///     what `registries` do not hold.
  Reconstruction(const std::string& sequence, const ReaderOptions& reading,
                 const PipelineOptions& options, const LabelTable& labels,
                 const SegmenterMaker& segmenter,
                 const Registries& registries = {});

  ImageFolderReader reader;  ///< At its first frame.
  SplitFusion fusion;        ///< Before its first frame.
  std::string note;          ///< On its colour images; empty if all is well.
  std::string rows_note;     ///< On the exposure of its rows; as `note`.

 private:
  void FindColorCamera();
  void FindRollingShutter(const LabelTable& labels);
};

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_RECONSTRUCTION_H_
