#ifndef SPLITFUSION_LIB_SEGMENTATION_UNDISTORTING_SEGMENTER_H_
#define SPLITFUSION_LIB_SEGMENTATION_UNDISTORTING_SEGMENTER_H_

#include <memory>
#include <vector>

#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/lens_distortion.h"

namespace splitfusion {

/// Passes on the masks of another segmenter that are those of colour files as
/// they are, with lens distortion, as those of the images without it.
class UndistortingSegmenter : public Segmenter {
 public:
  /// Both are shared and not null.
  UndistortingSegmenter(std::shared_ptr<Segmenter> source,
                        std::shared_ptr<const Undistortion> undistortion);

  /// @throw InputError as the source does.
  std::vector<InstanceMask> Segment(const Frame& frame) override;

  /// @throw InputError as the source does.
  std::vector<InstanceMask> Preview(const Frame& frame) override;

 private:
  std::vector<InstanceMask> Undistorted(
      std::vector<InstanceMask> instances) const;

  std::shared_ptr<Segmenter> source_;
  std::shared_ptr<const Undistortion> undistortion_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_UNDISTORTING_SEGMENTER_H_
