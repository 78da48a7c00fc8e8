#include "network_flags.h"

#include <gflags/gflags.h>

#include <sstream>
#include <string>

#include "flag_names.h"
#include "splitfusion/lib/base/error.h"

DEFINE_string(model, "", "Network that makes the masks, an ONNX file.");
DEFINE_string(decoder, "", "Kind of network: yolov8seg or yolact.");
DEFINE_string(network_size, "", "Size of its input, WxH; empty = the model's.");
DEFINE_string(class_names, "", "File with a class a line; empty = COCO's 80.");
DEFINE_double(score_threshold, 0.25,
              "Detections with a lower score are dropped.");
DEFINE_double(nms_threshold, 0.5, "Largest IoU of two detections of a class.");
DEFINE_int32(top_k, 100, "Detections in a frame at most.");

namespace splitfusion {
namespace {

constexpr int kMaxSide = 4096;  // Pixels.

cv::Size ParseSize(const std::string& text) {
  if (text.empty()) return {};
  std::stringstream stream(text);
  cv::Size size;
  char by = 0;
  const bool ok = (stream >> size.width >> by >> size.height) && by == 'x' &&
                  stream.peek() == EOF && size.width > 0 && size.height > 0 &&
                  size.width <= kMaxSide && size.height <= kMaxSide;
  CheckOption(ok, "network_size", text,
              "WxH, such as 640x480, at most " + std::to_string(kMaxSide));
  return size;
}

NetworkOptions OptionsFromFlags() {
  NetworkOptions options;
  options.model = FLAGS_model;
  options.decoder = FLAGS_decoder;
  options.input_size = ParseSize(FLAGS_network_size);
  if (!FLAGS_class_names.empty()) {
    options.class_names = ReadClassNames(FLAGS_class_names);
  }
  options.detections.score_threshold = FLAGS_score_threshold;
  options.detections.nms_threshold = FLAGS_nms_threshold;
  options.detections.top_k = FLAGS_top_k;
  return options;
}

}  // namespace

bool HasNetworkFlags() {
  CheckOption(!FLAGS_model.empty() || FLAGS_decoder.empty(), "model", "''",
              "an ONNX file to go with --decoder=" + FLAGS_decoder);
  return !FLAGS_model.empty();
}

std::unique_ptr<NetworkSegmenter> NetworkFromFlags() {
  std::unique_ptr<NetworkSegmenter> network;
  NamingFlags({{"input size", "network_size"}}, [&] {
    network = std::make_unique<NetworkSegmenter>(OptionsFromFlags());
  });
  return network;
}

}  // namespace splitfusion
