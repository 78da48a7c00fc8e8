#include "splitfusion/lib/segmentation/undistorting_segmenter.h"

#include <utility>

namespace splitfusion {

UndistortingSegmenter::UndistortingSegmenter(
    std::shared_ptr<Segmenter> source,
    std::shared_ptr<const Undistortion> undistortion)
    : source_(std::move(source)), undistortion_(std::move(undistortion)) {}

std::vector<InstanceMask> UndistortingSegmenter::Segment(const Frame& frame) {
  return Undistorted(source_->Segment(frame));
}

std::vector<InstanceMask> UndistortingSegmenter::Preview(const Frame& frame) {
  return Undistorted(source_->Preview(frame));
}

std::vector<InstanceMask> UndistortingSegmenter::Undistorted(
    std::vector<InstanceMask> instances) const {
  for (InstanceMask& instance : instances) {
    instance.mask = undistortion_->Mask(instance.mask);
  }
  return instances;
}

}  // namespace splitfusion
