#include "splitfusion/lib/segmentation/recording_segmenter.h"

#include <utility>

namespace splitfusion {

RecordingSegmenter::RecordingSegmenter(
    std::unique_ptr<Segmenter> source, const std::string& folder,
    const std::map<std::string, std::string>& settings)
    : source_(std::move(source)), folder_(folder), settings_(settings) {}

std::vector<InstanceMask> RecordingSegmenter::Segment(const Frame& frame) {
  if (!writer_) {
    writer_ = std::make_unique<MaskFolderWriter>(folder_, settings_);
  }
  const std::vector<InstanceMask> instances = source_->Segment(frame);
  // A run that goes on from a checkpoint comes by frames that are there.
  if (!writer_->Has(frame.stem)) writer_->Write(frame, instances);
  return instances;
}

std::vector<InstanceMask> RecordingSegmenter::Preview(const Frame& frame) {
  return source_->Preview(frame);
}

}  // namespace splitfusion
