#ifndef SPLITFUSION_LIB_SEGMENTATION_NETWORK_DECODER_H_
#define SPLITFUSION_LIB_SEGMENTATION_NETWORK_DECODER_H_

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/segmentation/input_placement.h"
#include "splitfusion/lib/segmentation/network_tensor.h"

namespace splitfusion {

/// Which detections of a network are kept.
struct DecoderOptions {
  double score_threshold = 0.25;  ///< Lower scores are dropped, 0..1.
  double nms_threshold = 0.5;     ///< Largest overlap (IoU) within a class.
  int top_k = 100;                ///< Best instances kept in a frame.

  /// @throw InputError if a value is out of its range.
  void Check() const;
};

/// What a decoder has to know of the frame whose outputs it reads.
struct DecoderInput {
  InputPlacement placement;  ///< Of the frame in the network's input.
  int classes = 0;           ///< Classes of the network, without background.
};

/// One instance found by a network.
struct NetworkInstance {
  int class_index = 0;  ///< Without background, from 0.
  double score = 0;     ///< 0..1.
  cv::Rect2d box;       ///< Frame, pixels (see InputPlacement).
  cv::Mat mask;         ///< Frame size, 8UC1, 255 inside.
};

/// What is particular to one kind of network: its input and its outputs.
/// Without state, so one decoder serves any number of frames.
class NetworkDecoder {
 public:
  virtual ~NetworkDecoder() = default;

  /// Names of the outputs, in the order in which Decode() takes them.
  virtual std::vector<std::string> OutputNames() const = 0;

  /// Input size where neither the model nor the user fixes it; empty if it has
  /// to be given.
  virtual cv::Size DefaultInputSize() const = 0;

  /// @throw InputError if the network cannot have an input of that size.
  virtual void CheckInputSize(cv::Size input) const = 0;

  /// Where a frame is put in the input.
  virtual InputPlacement Place(cv::Size frame, cv::Size input) const = 0;

  /// The input tensor, 1x3xHxW 32FC1.
  ///
  /// @param color 8UC3, BGR, of the placement's frame size.
  virtual cv::Mat MakeInput(const cv::Mat& color,
                            const InputPlacement& placement) const = 0;

  /// Instances of one frame, best score first.
  ///
  /// @throw InputError if an output has another shape than it has to have.
  virtual std::vector<NetworkInstance> Decode(
      const std::vector<NetworkTensor>& outputs, const DecoderInput& input,
      const DecoderOptions& options) const = 0;
};

/// Decoders by name.
using DecoderRegistry = Registry<NetworkDecoder>;

/// yolact and yolov8seg.
DecoderRegistry BuiltinDecoders();

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_NETWORK_DECODER_H_
