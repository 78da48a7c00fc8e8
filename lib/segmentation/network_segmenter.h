#ifndef SPLITFUSION_LIB_SEGMENTATION_NETWORK_SEGMENTER_H_
#define SPLITFUSION_LIB_SEGMENTATION_NETWORK_SEGMENTER_H_

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/class_names.h"
#include "splitfusion/lib/segmentation/network_decoder.h"
#include "splitfusion/lib/segmentation/onnx_network.h"
#include "splitfusion/lib/segmentation/segmenter.h"

namespace splitfusion {

/// Which network segments, and how its outputs are read.
struct NetworkOptions {
  std::string model;    ///< ONNX file.
  std::string decoder;  ///< One of BuiltinDecoders().
  /// Input size, pixels; empty = that of the model, or else of the decoder.
  cv::Size input_size;
  /// Names of the network's classes in its order, without background.
  std::vector<std::string> class_names = CocoClassNames();
  DecoderOptions detections;  ///< Which detections are kept.
};

/// Instance masks from a network (SplitFusion IV-A: YOLACT) on the CPU, for
/// frames of any size. The masks do not depend on the number of threads.
class NetworkSegmenter : public Segmenter {
 public:
  /// Loads the network and runs it once on an empty image, so that a model
  /// that does not fit is refused here.
  ///
  /// @throw InputError on bad options, a file that OpenCV does not take, or
  ///     outputs that are not those of the decoder.
  explicit NetworkSegmenter(const NetworkOptions& options);

  /// @throw InputError if the outputs are broken.
  std::vector<InstanceMask> Segment(const Frame& frame) override;

  /// Input size in use, pixels.
  cv::Size input_size() const { return input_size_; }

  /// What the masks depend on, by name: equal settings give equal masks.
  std::map<std::string, std::string> Settings() const;

 private:
  cv::Size ChooseInputSize() const;
  std::vector<NetworkInstance> Run(const cv::Mat& color);

  NetworkOptions options_;
  std::unique_ptr<NetworkDecoder> decoder_;
  OnnxNetwork network_;
  cv::Size input_size_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_NETWORK_SEGMENTER_H_
