#ifndef SPLITFUSION_LIB_TRACKING_FEATURE_NETWORK_H_
#define SPLITFUSION_LIB_TRACKING_FEATURE_NETWORK_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "splitfusion/lib/segmentation/onnx_network.h"
#include "splitfusion/lib/tracking/image_features.h"

namespace splitfusion {

/// Features of whole images from XFeat (Potje et al. 2024, "XFeat: Accelerated
/// Features for Lightweight Image Matching") in an ONNX file of one grey image,
/// HxW a fixed size in eights, and two outputs of cells of 8x8 pixels:
/// `keypoint_logits`, 65 a cell: of each pixel, row by row, and of none; and
/// `descriptors`, 64 a cell. Frames of another size are stretched.
class FeatureNetwork {
 public:
  /// Loads the network and runs it once on an empty image.
  ///
  /// @throw InputError on a file that OpenCV does not take, or whose input or
  ///     outputs are others.
  explicit FeatureNetwork(const std::string& path);

  /// Features whose probability is greatest within two pixels of the network's
  /// image and above `min_score`; pixels are those of `grey`, of any size. Not
  /// for two threads at a time.
  ///
  /// @throw InputError if the outputs are of other shapes.
  ImageFeatures Find(const cv::Mat_<std::uint8_t>& grey, double min_score);

 private:
  OnnxNetwork network_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_FEATURE_NETWORK_H_
