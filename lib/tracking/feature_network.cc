#include "splitfusion/lib/tracking/feature_network.h"

#include <algorithm>
#include <cmath>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/segmentation/network_tensor.h"
#include "splitfusion/lib/sequence/image_file.h"

namespace splitfusion {
namespace {

constexpr int kCell = 8, kLogits = kCell * kCell + 1;  // Format: of XFeat.
constexpr int kDescriptor = 64;                        // Format: of XFeat.
constexpr int kApart = 5;  // Format: window of XFeat's maxima, pixels.

/// A grey image with a mean of 0 and a variance of 1, as a network's input.
cv::Mat InputOf(const cv::Mat_<std::uint8_t>& grey, const cv::Size& size) {
  cv::Mat_<std::uint8_t> resized;
  cv::resize(grey, resized, size);
  cv::Mat_<float> image;
  resized.convertTo(image, CV_32F, 1 / 255.0);  // Unit.
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  constexpr double kFlat = 1e-5;  // Format: what XFeat adds to the variance.
  image = (image - mean[0]) / std::sqrt(deviation[0] * deviation[0] + kFlat);
  return cv::dnn::blobFromImage(image);
}

/// Probability of every pixel to be a key point; `logits`: 65 rows, a column
/// for each cell of `cells`.
cv::Mat_<float> Probability(const cv::Mat_<float>& logits,
                            const cv::Size& cells) {
  cv::Mat_<float> probability(cells.height * kCell, cells.width * kCell);
  for (int cell = 0; cell < logits.cols; ++cell) {
    float most = logits(0, cell);
    for (int k = 1; k < kLogits; ++k) most = std::max(most, logits(k, cell));
    float sum = 0;
    for (int k = 0; k < kLogits; ++k) sum += std::exp(logits(k, cell) - most);
    const int u = cell % cells.width * kCell, v = cell / cells.width * kCell;
    for (int k = 0; k < kCell * kCell; ++k) {
      probability(v + k / kCell, u + k % kCell) =
          std::exp(logits(k, cell) - most) / sum;
    }
  }
  return probability;
}

/// The descriptor at a pixel, between those of the cells about it.
cv::Mat_<float> DescriptorAt(const cv::Mat_<float>& descriptors,
                             const cv::Size& cells, const cv::Point& pixel) {
  const float x = (pixel.x + 0.5f) / kCell - 0.5f;
  const float y = (pixel.y + 0.5f) / kCell - 0.5f;
  const int left = static_cast<int>(std::floor(x));
  const int top = static_cast<int>(std::floor(y));
  cv::Mat_<float> descriptor(1, kDescriptor, 0.f);
  for (int corner = 0; corner < 4; ++corner) {
    const int i = left + corner % 2, j = top + corner / 2;
    const float weight = (1 - std::abs(x - static_cast<float>(i))) *
                         (1 - std::abs(y - static_cast<float>(j)));
    const int cell = std::clamp(j, 0, cells.height - 1) * cells.width +
                     std::clamp(i, 0, cells.width - 1);
    for (int k = 0; k < kDescriptor; ++k) {
      descriptor(0, k) += weight * descriptors(k, cell);
    }
  }
  return descriptor / std::max(1e-12, cv::norm(descriptor));
}

}  // namespace

FeatureNetwork::FeatureNetwork(const std::string& path)
    : network_(path, /*channels=*/1) {
  network_.CheckOutputs({"keypoint_logits", "descriptors"});
  const cv::Size size = network_.input_size();
  if (size.empty() || size.width % kCell != 0 || size.height % kCell != 0) {
    throw InputError(path + ": input of " + ToString(size) +
                     ": expected a fixed width and height in eights");
  }
  Find(cv::Mat_<std::uint8_t>(size, std::uint8_t{0}), 1);
}

ImageFeatures FeatureNetwork::Find(const cv::Mat_<std::uint8_t>& grey,
                                   double min_score) {
  const cv::Size size = network_.input_size();
  const cv::Size cells(size.width / kCell, size.height / kCell);
  const std::vector<NetworkTensor> outputs =
      network_.Forward(InputOf(grey, size), {"keypoint_logits", "descriptors"});
  try {
    CheckShape(outputs[0], {kLogits, cells.height, cells.width},
               "65 values a cell");
    CheckShape(outputs[1], {kDescriptor, cells.height, cells.width},
               "64 values a cell");
  } catch (const InputError& error) {
    throw InputError(network_.path() + ": " + error.what());
  }
  const cv::Mat_<float> descriptors = AsMatrix(outputs[1].data, kDescriptor);
  const cv::Mat_<float> probability =
      Probability(AsMatrix(outputs[0].data, kLogits), cells);
  cv::Mat_<float> most;
  cv::dilate(probability, most, cv::Mat::ones(kApart, kApart, CV_8U));
  const float scale_u = static_cast<float>(grey.cols) / size.width;
  const float scale_v = static_cast<float>(grey.rows) / size.height;
  ImageFeatures found;
  for (int v = 0; v < probability.rows; ++v) {
    for (int u = 0; u < probability.cols; ++u) {
      if (!(probability(v, u) > min_score) || probability(v, u) < most(v, u)) {
        continue;
      }
      found.pixels.emplace_back((u + 0.5f) * scale_u - 0.5f,
                                (v + 0.5f) * scale_v - 0.5f);
      found.descriptors.push_back(DescriptorAt(descriptors, cells, {u, v}));
    }
  }
  return found;
}

}  // namespace splitfusion
