#include "splitfusion/lib/segmentation/network_tensor.h"

#include <algorithm>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

std::vector<int> ShapeOf(const cv::Mat& tensor, std::size_t dimensions) {
  std::vector<int> shape(tensor.size.p, tensor.size.p + tensor.dims);
  while (shape.size() > dimensions && shape.front() == 1) {
    shape.erase(shape.begin());
  }
  return shape;
}

std::string ShapeText(const std::vector<int>& shape) {
  std::string text;
  for (const int length : shape) {
    text += (text.empty() ? "" : "x") + std::to_string(length);
  }
  return text;
}

std::vector<int> CheckShape(const NetworkTensor& tensor,
                            const std::vector<int>& expected,
                            const std::string& expected_text) {
  const std::vector<int> found = ShapeOf(tensor.data, expected.size());
  const bool fits = tensor.data.type() == CV_32FC1 &&
                    found.size() == expected.size() &&
                    std::equal(found.begin(), found.end(), expected.begin(),
                               [](int f, int e) { return e == -1 || f == e; });
  if (fits) return found;
  throw InputError("output '" + tensor.name + "' is " +
                   ShapeText(ShapeOf(tensor.data, tensor.data.dims)) +
                   ": expected " + expected_text);
}

cv::Mat AsMatrix(const cv::Mat& tensor, int rows) {
  const int columns = static_cast<int>(tensor.total() / rows);
  const int sizes[] = {rows, columns};
  return tensor.reshape(1, 2, sizes);
}

cv::Mat MaskProbability(const cv::Mat& prototypes,
                        const std::vector<float>& coefficients, cv::Size size) {
  cv::Mat sum = cv::Mat::zeros(1, size.area(), CV_32F);
  for (std::size_t m = 0; m < coefficients.size(); ++m) {
    cv::scaleAdd(prototypes.row(static_cast<int>(m)), coefficients[m], sum,
                 sum);
  }
  cv::Mat exponential;
  cv::exp(-sum, exponential);
  cv::Mat probability = 1.0 / (1.0 + exponential);
  return probability.reshape(1, size.height);
}

}  // namespace splitfusion
