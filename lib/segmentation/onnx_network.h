#ifndef SPLITFUSION_LIB_SEGMENTATION_ONNX_NETWORK_H_
#define SPLITFUSION_LIB_SEGMENTATION_ONNX_NETWORK_H_

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/segmentation/network_tensor.h"

namespace splitfusion {

/// An image network from an ONNX file, run by cv::dnn on the CPU with
/// OpenCV's threads. The same input gives the same output.
class OnnxNetwork {
 public:
  /// `channels`: of the image, 3 or 1.
  /// @throw InputError if the file is missing, is not ONNX, has other than one
  ///     input or one that is no image, or holds what OpenCV does not take.
  explicit OnnxNetwork(const std::string& path, int channels = 3);
  ~OnnxNetwork();

  /// File of the network.
  const std::string& path() const { return path_; }
  /// Size of the file's content and a checksum of it, "13842654 bytes,
  /// fnv1a 0123456789abcdef".
  const std::string& fingerprint() const { return fingerprint_; }
  /// Input size, pixels; empty where the file leaves it open.
  cv::Size input_size() const { return input_size_; }

  /// @throw InputError unless the graph has all of these outputs; lists those
  ///     that it has.
  void CheckOutputs(const std::vector<std::string>& names) const;

  /// Outputs for one input of 1xCxHxW, in the order of `names`.
  ///
  /// @throw InputError if OpenCV cannot run the network on it.
  std::vector<NetworkTensor> Forward(const cv::Mat& input,
                                     const std::vector<std::string>& names);

 private:
  struct Net;  // Keeps cv::dnn out of this header.

  std::string path_;
  std::string fingerprint_;
  cv::Size input_size_;
  std::vector<std::string> outputs_;  // With their shapes, for messages.
  std::vector<std::string> output_names_;
  std::unique_ptr<Net> net_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_ONNX_NETWORK_H_
