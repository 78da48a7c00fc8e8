#ifndef SPLITFUSION_LIB_SEGMENTATION_ONNX_FILE_H_
#define SPLITFUSION_LIB_SEGMENTATION_ONNX_FILE_H_

#include <string>
#include <vector>

namespace splitfusion {

/// An input or output of an ONNX graph.
struct OnnxValue {
  std::string name;        ///< As the graph calls it.
  std::vector<int> shape;  ///< 0 = left open; empty if not stated at all.
};

/// What an ONNX file says of its graph. OpenCV 4.6 runs graphs, but tells
/// neither the size of their inputs nor, in one line, what it refuses.
struct OnnxGraph {
  std::vector<OnnxValue> inputs;   ///< Without the weights.
  std::vector<OnnxValue> outputs;  ///< In the order of the graph.
};

/// Reads inputs and outputs of a graph out of the bytes of an ONNX file.
///
/// `path`: for messages.
/// @throw InputError if the bytes are no ONNX model, or hold weights of half
///     precision, which OpenCV 4.6 does not take.
OnnxGraph ReadOnnxGraph(const std::string& bytes, const std::string& path);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_ONNX_FILE_H_
