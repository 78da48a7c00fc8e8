#include "splitfusion/lib/segmentation/yolov8seg_decoder.h"

#include <algorithm>
#include <map>
#include <opencv2/dnn.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

constexpr int kBoxRows = 4;

/// One anchor that detects something.
struct AnchorDetection {
  int anchor = 0;
  int class_index = 0;
  float score = 0;
  cv::Rect2d box;  // Input, pixels.
};

/// Shape of the prototypes, M x H x W.
std::vector<int> CheckOutputs(const std::vector<NetworkTensor>& outputs,
                              const DecoderInput& input) {
  const int rows = input.placement.input.height / 4;
  const int columns = input.placement.input.width / 4;
  const std::vector<int> shape = CheckShape(
      outputs.at(1), {-1, rows, columns},
      "1xMx" + ShapeText({rows, columns}) + ", M prototypes for an input of " +
          ToString(input.placement.input));
  const int prototypes = shape[0];
  const int expected = kBoxRows + input.classes + prototypes;
  CheckShape(outputs.at(0), {expected, -1},
             "1x" + std::to_string(expected) + "xN, a box, " +
                 std::to_string(input.classes) +
                 " classes (by their names) and " + std::to_string(prototypes) +
                 " mask coefficients");
  return shape;
}

cv::Rect2d BoxOf(const cv::Mat& detections, int anchor) {
  const double width = detections.at<float>(2, anchor);
  const double height = detections.at<float>(3, anchor);
  return {detections.at<float>(0, anchor) - width / 2,
          detections.at<float>(1, anchor) - height / 2, width, height};
}

/// Anchors by class; within a class in their order.
std::map<int, std::vector<AnchorDetection>> FindCandidates(
    const cv::Mat& detections, int classes, double threshold) {
  std::map<int, std::vector<AnchorDetection>> candidates;
  for (int anchor = 0; anchor < detections.cols; ++anchor) {
    AnchorDetection best;
    for (int c = 0; c < classes; ++c) {
      const float score = detections.at<float>(kBoxRows + c, anchor);
      if (score > best.score) best = {anchor, c, score, {}};
    }
    if (best.score <= threshold) continue;
    best.box = BoxOf(detections, anchor);
    candidates[best.class_index].push_back(best);
  }
  return candidates;
}

void AppendWithoutDoubles(const std::vector<AnchorDetection>& candidates,
                          double nms_threshold,
                          std::vector<AnchorDetection>* kept) {
  std::vector<cv::Rect2d> boxes;
  std::vector<float> scores;
  for (const AnchorDetection& candidate : candidates) {
    boxes.push_back(candidate.box);
    scores.push_back(candidate.score);
  }
  std::vector<int> chosen;
  cv::dnn::NMSBoxes(boxes, scores, 0.0f, static_cast<float>(nms_threshold),
                    chosen);
  for (const int i : chosen) kept->push_back(candidates[i]);
}

std::vector<AnchorDetection> BestCandidates(const cv::Mat& detections,
                                            int classes,
                                            const DecoderOptions& options) {
  std::vector<AnchorDetection> kept;
  for (const auto& [class_index, candidates] :
       FindCandidates(detections, classes, options.score_threshold)) {
    AppendWithoutDoubles(candidates, options.nms_threshold, &kept);
  }
  std::stable_sort(kept.begin(), kept.end(),
                   [](const AnchorDetection& a, const AnchorDetection& b) {
                     return a.score > b.score;
                   });
  if (kept.size() > static_cast<std::size_t>(options.top_k)) {
    kept.resize(options.top_k);
  }
  return kept;
}

class Yolov8SegDecoder : public NetworkDecoder {
 public:
  std::vector<std::string> OutputNames() const override {
    return {"output0", "output1"};
  }
  cv::Size DefaultInputSize() const override { return {640, 640}; }
  void CheckInputSize(cv::Size input) const override {
    CheckOption(input.width % 32 == 0 && input.height % 32 == 0, "input size",
                ToString(input), "multiples of 32 for yolov8seg");
  }
  InputPlacement Place(cv::Size frame, cv::Size input) const override {
    return Letterbox(frame, input);
  }
  cv::Mat MakeInput(const cv::Mat& color,
                    const InputPlacement& placement) const override {
    return cv::dnn::blobFromImage(
        PlaceFrame(color, placement, cv::Scalar::all(114)), 1.0 / 255,
        cv::Size(), cv::Scalar(), /*swapRB=*/true);
  }
  std::vector<NetworkInstance> Decode(
      const std::vector<NetworkTensor>& outputs, const DecoderInput& input,
      const DecoderOptions& options) const override {
    const std::vector<int> shape = CheckOutputs(outputs, input);
    const cv::Size prototype_size(shape[2], shape[1]);
    const cv::Mat prototypes = AsMatrix(outputs.at(1).data, shape[0]);
    const int first_coefficient = kBoxRows + input.classes;
    const cv::Mat detections =
        AsMatrix(outputs.at(0).data, first_coefficient + shape[0]);
    std::vector<NetworkInstance> instances;
    for (const AnchorDetection& candidate :
         BestCandidates(detections, input.classes, options)) {
      std::vector<float> coefficients(shape[0]);
      for (int m = 0; m < shape[0]; ++m) {
        coefficients[m] =
            detections.at<float>(first_coefficient + m, candidate.anchor);
      }
      NetworkInstance instance{
          candidate.class_index, candidate.score,
          input.placement.FrameBox(candidate.box),
          FrameMask(MaskProbability(prototypes, coefficients, prototype_size),
                    input.placement)};
      ClearOutside(instance.box, &instance.mask);
      instances.push_back(instance);
    }
    return instances;
  }
};

}  // namespace

std::unique_ptr<NetworkDecoder> MakeYolov8SegDecoder() {
  return std::make_unique<Yolov8SegDecoder>();
}

}  // namespace splitfusion
