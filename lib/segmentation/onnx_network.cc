#include "splitfusion/lib/segmentation/onnx_network.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <sstream>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/segmentation/onnx_file.h"

namespace splitfusion {
namespace {

namespace logging = cv::utils::logging;

/// Silences OpenCV, which prints pages on what it then throws as well.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(logging::setLogLevel(logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  logging::LogLevel before_;
};

std::string ReadBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || std::filesystem::is_directory(path)) {
    throw InputError(path + ": cannot be opened: expected an ONNX file");
  }
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string Fingerprint(const std::string& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char byte : bytes) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  }
  return cv::format("%zu bytes, fnv1a %016lx", bytes.size(), hash);
}

/// What OpenCV complains of, in one line: its own quotes of quotes, marked by
/// lines that begin with >, are joined.
std::string OneLine(const cv::Exception& error) {
  std::istringstream words(error.err.empty() ? error.what() : error.err);
  std::string text;
  for (std::string word; words >> word;) {
    if (word != ">") text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

cv::Size ImageSize(const OnnxGraph& graph, const std::string& path,
                   int channels) {
  if (graph.inputs.size() != 1) {
    throw InputError(path + ": " + std::to_string(graph.inputs.size()) +
                     " inputs: expected one, an image");
  }
  const std::vector<int>& shape = graph.inputs[0].shape;
  if (shape.empty()) return {};
  if (shape.size() != 4 || shape[0] > 1 ||
      (shape[1] != channels && shape[1] != 0)) {
    throw InputError(path + ": input '" + graph.inputs[0].name + "' is " +
                     ShapeText(shape) + ": expected 1x" +
                     std::to_string(channels) + "xHxW, one image");
  }
  if (shape[2] <= 0 || shape[3] <= 0) return {};
  return {shape[3], shape[2]};
}

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

}  // namespace

/// The network in OpenCV.
struct OnnxNetwork::Net {
  cv::dnn::Net net;  ///< Ready to run.
};

OnnxNetwork::OnnxNetwork(const std::string& path, int channels) : path_(path) {
  const std::string bytes = ReadBytes(path);
  const OnnxGraph graph = ReadOnnxGraph(bytes, path);
  fingerprint_ = Fingerprint(bytes);
  input_size_ = ImageSize(graph, path, channels);
  for (const OnnxValue& output : graph.outputs) {
    output_names_.push_back(output.name);
    outputs_.push_back(output.name + " " + ShapeText(output.shape));
  }
  net_ = std::make_unique<Net>();
  const QuietOpenCv quiet;
  try {
    net_->net = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
  } catch (const cv::Exception& error) {
    throw InputError(path + ": OpenCV " + CV_VERSION +
                     " cannot load the network (docs/segmentation.md says "
                     "what it takes): " +
                     OneLine(error));
  }
  net_->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_->net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
}

OnnxNetwork::~OnnxNetwork() = default;

void OnnxNetwork::CheckOutputs(const std::vector<std::string>& names) const {
  for (const std::string& name : names) {
    if (std::count(output_names_.begin(), output_names_.end(), name) > 0) {
      continue;
    }
    throw InputError(path_ + ": no output '" + name + "': found " +
                     Joined(outputs_) + "; expected " + Joined(names));
  }
}

std::vector<NetworkTensor> OnnxNetwork::Forward(
    const cv::Mat& input, const std::vector<std::string>& names) {
  std::vector<cv::Mat> blobs;
  const QuietOpenCv quiet;
  try {
    net_->net.setInput(input);
    net_->net.forward(blobs, names);
  } catch (const cv::Exception& error) {
    throw InputError(path_ + ": OpenCV " + CV_VERSION +
                     " cannot run the network on an input of " +
                     ShapeText(ShapeOf(input, input.dims)) + ": " +
                     OneLine(error));
  }
  std::vector<NetworkTensor> outputs;
  for (std::size_t i = 0; i < names.size(); ++i) {
    outputs.push_back({names[i], blobs[i]});
  }
  return outputs;
}

}  // namespace splitfusion
