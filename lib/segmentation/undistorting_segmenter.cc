#include "splitfusion/lib/segmentation/undistorting_segmenter.h"

#include <utility>

namespace splitfusion {

UndistortingSegmenter::UndistortingSegmenter(
    std::shared_ptr<Segmenter> source,
    std::shared_ptr<const Undistortion> undistortion)
    : source_(std::move(source)), undistortion_(std::move(undistortion)) {}

std::vector<InstanceMask> UndistortingSegmenter::Segment(const Frame& frame) {
  std::vector<InstanceMask> instances = source_->Segment(frame);
  for (InstanceMask& instance : instances) {
    instance.mask = undistortion_->Mask(instance.mask);
  }
  return instances;
}

}  // namespace splitfusion
