#ifndef SPLITFUSION_LIB_SEGMENTATION_SEGMENTER_H_
#define SPLITFUSION_LIB_SEGMENTATION_SEGMENTER_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/frame.h"

namespace splitfusion {

/// One detected instance of one frame.
struct InstanceMask {
  cv::Mat mask;            ///< HxW 8UC1, 255 inside, 0 outside.
  std::string class_name;  ///< COCO name, or "object" if the source has none.
  double score = 1.0;      ///< 0..1.
  /// The detector's box, pixels (pixel (i, j) covers [i, i + 1) x [j, j + 1));
  /// empty if the source has none.
  cv::Rect2d box = {};
  /// Of the instance through all frames, if that is known; 0 = not.
  int identity = 0;
};

/// Source of instance masks (SplitFusion IV-A): files, or a network.
class Segmenter {
 public:
  virtual ~Segmenter() = default;

  /// Instances of one frame, best score first; empty if there are none.
  ///
  /// @throw InputError on a broken mask file or network output.
  virtual std::vector<InstanceMask> Segment(const Frame& frame) = 0;

  /// The same of a frame before its turn: nothing is recorded.
  ///
  /// @throw InputError as Segment().
  virtual std::vector<InstanceMask> Preview(const Frame& frame) {
    return Segment(frame);
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_SEGMENTER_H_
