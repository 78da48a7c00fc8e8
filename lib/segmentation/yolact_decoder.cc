#include "splitfusion/lib/segmentation/yolact_decoder.h"

#include <algorithm>
#include <cmath>
#include <opencv2/dnn.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/segmentation/yolact_priors.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

constexpr float kMinConfidence = 0.05f;  // Of a candidate's best class.
constexpr std::size_t kMaxPerClass = 200;
constexpr double kCropPadding = 1;  // Prototype pixels.

/// BGR, 0..255.
const cv::Scalar kMean(103.94, 116.78, 123.68);
const cv::Scalar kDeviation(57.38, 57.12, 58.40);

/// A prior as an instance of one class.
struct PriorDetection {
  int prior = 0;
  int class_index = 0;
  float score = 0;
  cv::Rect2f box;  // Parts of the input's width and height.
};

/// The outputs as matrices, their shapes checked.
struct CheckedOutputs {
  cv::Mat loc;         // P x 4
  cv::Mat conf;        // P x (1 + C)
  cv::Mat mask;        // P x M
  cv::Mat prototypes;  // M x (H * W)
  cv::Size prototype_size;
};

CheckedOutputs CheckOutputs(const std::vector<NetworkTensor>& outputs,
                            int priors, const DecoderInput& input) {
  const NetworkTensor &loc = outputs.at(0), &conf = outputs.at(1);
  const NetworkTensor &mask = outputs.at(2), &proto = outputs.at(3);
  const int columns = 1 + input.classes;
  const std::string rows = "1x" + std::to_string(priors) + "x";
  const std::string size =
      " for an input of " + ToString(input.placement.input);
  CheckShape(loc, {priors, 4}, rows + "4" + size);
  CheckShape(conf, {priors, columns},
             rows + std::to_string(columns) + ", background and " +
                 std::to_string(input.classes) + " classes (by their names)," +
                 size);
  const std::vector<int> shape =
      CheckShape(proto, {-1, -1, -1}, "1xHxWxM, M prototypes");
  CheckShape(mask, {priors, shape[2]},
             rows + std::to_string(shape[2]) + ", one for each prototype of '" +
                 proto.name + "',");
  return {AsMatrix(loc.data, priors),
          AsMatrix(conf.data, priors),
          AsMatrix(mask.data, priors),
          AsMatrix(proto.data, shape[0] * shape[1]).t(),
          {shape[1], shape[0]}};
}

/// Priors whose best class is probable enough.
std::vector<int> CandidatePriors(const cv::Mat& conf) {
  std::vector<int> priors;
  for (int row = 0; row < conf.rows; ++row) {
    const float* scores = conf.ptr<float>(row);
    const float best = *std::max_element(scores + 1, scores + conf.cols);
    if (best > kMinConfidence) priors.push_back(row);
  }
  return priors;
}

bool IsBetter(const PriorDetection& a, const PriorDetection& b) {
  return a.score > b.score;
}

/// What remains of one class, best score first.
///
/// A better box suppresses, so those below the threshold change nothing above.
std::vector<PriorDetection> KeepOfClass(int class_index,
                                        const std::vector<int>& priors,
                                        const std::vector<cv::Rect2f>& boxes,
                                        const cv::Mat& conf,
                                        const DecoderOptions& options) {
  std::vector<PriorDetection> candidates;
  for (std::size_t i = 0; i < priors.size(); ++i) {
    const float score = conf.at<float>(priors[i], 1 + class_index);
    if (score <= options.score_threshold) continue;
    candidates.push_back({priors[i], class_index, score, boxes[i]});
  }
  std::stable_sort(candidates.begin(), candidates.end(), IsBetter);
  if (candidates.size() > kMaxPerClass) candidates.resize(kMaxPerClass);
  std::vector<cv::Rect2f> sorted;
  for (const PriorDetection& candidate : candidates)
    sorted.push_back(candidate.box);
  std::vector<PriorDetection> kept;
  for (const int i : FastNms(sorted, options.nms_threshold)) {
    kept.push_back(candidates[i]);
  }
  return kept;
}

std::vector<PriorDetection> BestCandidates(const CheckedOutputs& outputs,
                                           int input,
                                           const DecoderOptions& options) {
  const std::vector<CenterBox> all_priors = YolactPriors(input);
  const std::vector<int> priors = CandidatePriors(outputs.conf);
  std::vector<cv::Rect2f> boxes;
  for (const int prior : priors) {
    boxes.push_back(
        DecodeYolactBox(all_priors[prior], outputs.loc.ptr<float>(prior)));
  }
  std::vector<PriorDetection> kept;
  for (int c = 0; c + 1 < outputs.conf.cols; ++c) {
    const std::vector<PriorDetection> of_class =
        KeepOfClass(c, priors, boxes, outputs.conf, options);
    kept.insert(kept.end(), of_class.begin(), of_class.end());
  }
  std::stable_sort(kept.begin(), kept.end(), IsBetter);
  if (kept.size() > static_cast<std::size_t>(options.top_k)) {
    kept.resize(options.top_k);
  }
  return kept;
}

/// The box in prototype pixels with a margin around; what it covers of a pixel
/// counts by the pixel's upper left corner.
cv::Mat Cropped(const cv::Mat& probability, const cv::Rect2f& box) {
  const auto first = [](double edge, int length) {
    return std::clamp(static_cast<int>(std::ceil(edge)), 0, length);
  };
  const int columns = probability.cols;
  const int rows = probability.rows;
  const cv::Point begin(first(box.x * columns - kCropPadding, columns),
                        first(box.y * rows - kCropPadding, rows));
  const cv::Point end(
      first((box.x + box.width) * columns + kCropPadding, columns),
      first((box.y + box.height) * rows + kCropPadding, rows));
  cv::Mat cropped = cv::Mat::zeros(probability.size(), probability.type());
  const cv::Rect inside(begin, end);
  if (!inside.empty()) probability(inside).copyTo(cropped(inside));
  return cropped;
}

NetworkInstance MakeInstance(const PriorDetection& candidate,
                             const CheckedOutputs& outputs,
                             const InputPlacement& placement) {
  const float* row = outputs.mask.ptr<float>(candidate.prior);
  const cv::Mat probability =
      MaskProbability(outputs.prototypes, {row, row + outputs.mask.cols},
                      outputs.prototype_size);
  const cv::Size2d input = placement.input;
  const cv::Rect2d input_box(
      candidate.box.x * input.width, candidate.box.y * input.height,
      candidate.box.width * input.width, candidate.box.height * input.height);
  return {candidate.class_index, candidate.score, placement.FrameBox(input_box),
          FrameMask(Cropped(probability, candidate.box), placement)};
}

}  // namespace

std::vector<int> FastNms(const std::vector<cv::Rect2f>& boxes,
                         double threshold) {
  const auto overlap = [&](std::size_t a, std::size_t b) {
    const float both = (boxes[a] & boxes[b]).area();
    const float either = boxes[a].area() + boxes[b].area() - both;
    return either > 0 ? both / either : 0.0f;
  };
  std::vector<int> kept;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    float worst = 0;
    for (std::size_t better = 0; better < i; ++better) {
      worst = std::max(worst, overlap(better, i));
    }
    if (worst <= threshold) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

namespace {

class YolactDecoder : public NetworkDecoder {
 public:
  std::vector<std::string> OutputNames() const override {
    return {"loc", "conf", "mask", "proto"};
  }
  cv::Size DefaultInputSize() const override { return {550, 550}; }
  void CheckInputSize(cv::Size input) const override {
    CheckOption(input.width == input.height && input.width >= 32, "input size",
                ToString(input), "a square for yolact, such as 550x550");
  }
  InputPlacement Place(cv::Size frame, cv::Size input) const override {
    return Stretch(frame, input);
  }
  cv::Mat MakeInput(const cv::Mat& color,
                    const InputPlacement& placement) const override {
    cv::Mat image;
    color.convertTo(image, CV_32F);
    image = PlaceFrame(image, placement, cv::Scalar());
    cv::subtract(image, kMean, image);
    cv::divide(image, kDeviation, image);
    return cv::dnn::blobFromImage(image, 1.0, cv::Size(), cv::Scalar(),
                                  /*swapRB=*/true);
  }
  std::vector<NetworkInstance> Decode(
      const std::vector<NetworkTensor>& outputs, const DecoderInput& input,
      const DecoderOptions& options) const override {
    const int side = input.placement.input.width;
    const int priors = static_cast<int>(YolactPriors(side).size());
    const CheckedOutputs checked = CheckOutputs(outputs, priors, input);
    std::vector<NetworkInstance> instances;
    for (const PriorDetection& candidate :
         BestCandidates(checked, side, options)) {
      instances.push_back(MakeInstance(candidate, checked, input.placement));
    }
    return instances;
  }
};

}  // namespace

std::unique_ptr<NetworkDecoder> MakeYolactDecoder() {
  return std::make_unique<YolactDecoder>();
}

}  // namespace splitfusion
