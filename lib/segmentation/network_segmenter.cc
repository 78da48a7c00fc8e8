#include "splitfusion/lib/segmentation/network_segmenter.h"

#include <cmath>
#include <filesystem>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

const NetworkOptions& Checked(const NetworkOptions& options) {
  CheckOption(!options.model.empty(), "model", "''", "an ONNX file");
  CheckOption(!options.class_names.empty(), "class names", 0, "at least one");
  options.detections.Check();
  return options;
}

/// Scores and boxes have as many digits as their file (DetectionList), so that
/// masks read back are those that were given.
double Rounded(double value, double digits) {
  const double scale = std::pow(10.0, digits);
  return std::round(value * scale) / scale;
}

}  // namespace

NetworkSegmenter::NetworkSegmenter(const NetworkOptions& options)
    : options_(Checked(options)),
      decoder_(BuiltinDecoders().Make(options.decoder)),
      network_(options.model) {
  network_.CheckOutputs(decoder_->OutputNames());
  input_size_ = ChooseInputSize();
  Run(cv::Mat(input_size_, CV_8UC3, cv::Scalar::all(114)));
}

cv::Size NetworkSegmenter::ChooseInputSize() const {
  const cv::Size of_model = network_.input_size();
  cv::Size size = options_.input_size;
  if (size.empty()) size = of_model;
  if (size.empty()) size = decoder_->DefaultInputSize();
  CheckOption(of_model.empty() || size == of_model, "input size",
              ToString(size),
              ToString(of_model) + ", the size fixed in " + network_.path());
  decoder_->CheckInputSize(size);
  return size;
}

std::vector<NetworkInstance> NetworkSegmenter::Run(const cv::Mat& color) {
  DecoderInput input;
  input.placement = decoder_->Place(color.size(), input_size_);
  input.classes = static_cast<int>(options_.class_names.size());
  const std::vector<NetworkTensor> outputs = network_.Forward(
      decoder_->MakeInput(color, input.placement), decoder_->OutputNames());
  try {
    return decoder_->Decode(outputs, input, options_.detections);
  } catch (const InputError& error) {
    throw InputError(network_.path() + ": " + error.what());
  }
}

std::vector<InstanceMask> NetworkSegmenter::Segment(const Frame& frame) {
  std::vector<InstanceMask> instances;
  for (NetworkInstance& found : Run(frame.color)) {
    if (cv::countNonZero(found.mask) == 0) continue;
    InstanceMask instance;
    instance.mask = found.mask;
    instance.class_name = options_.class_names[found.class_index];
    instance.score = Rounded(found.score, 4);
    instance.box = {Rounded(found.box.x, 1), Rounded(found.box.y, 1),
                    Rounded(found.box.width, 1), Rounded(found.box.height, 1)};
    instances.push_back(instance);
  }
  return instances;
}

std::map<std::string, std::string> NetworkSegmenter::Settings() const {
  std::string classes;
  for (const std::string& name : options_.class_names) classes += name + "\n";
  const DecoderOptions& kept = options_.detections;
  return {{"model", std::filesystem::path(options_.model).filename().string()},
          {"model_content", network_.fingerprint()},
          {"decoder", options_.decoder},
          {"input_size", ToString(input_size_)},
          {"class_names", classes},
          {"score_threshold", cv::format("%g", kept.score_threshold)},
          {"nms_threshold", cv::format("%g", kept.nms_threshold)},
          {"top_k", std::to_string(kept.top_k)}};
}

}  // namespace splitfusion
