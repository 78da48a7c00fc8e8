#ifndef SPLITFUSION_TOOLS_MASK_FLAGS_H_
#define SPLITFUSION_TOOLS_MASK_FLAGS_H_

#include <memory>
#include <string>

#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/pipeline_options.h"

namespace splitfusion {

/// The label table of the flags.
///
/// @throw InputError if its file is missing or broken.
LabelTable LabelsFromFlags();

/// What makes the masks of a sequence, by the flags; null if nothing does.
/// Warns if masks were looked for and not found or lack frames, and of classes
/// to be merged that nothing knows. `run`: run directory, which keeps the masks
/// of a network.
///
/// @throw InputError if a flag's value is out of its range, or the masks do not
///     fit.
std::shared_ptr<Segmenter> SegmenterFromFlags(const ImageFolderReader& reader,
                                              const PipelineOptions& options,
                                              const std::string& run);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_MASK_FLAGS_H_
