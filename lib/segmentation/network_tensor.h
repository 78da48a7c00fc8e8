#ifndef SPLITFUSION_LIB_SEGMENTATION_NETWORK_TENSOR_H_
#define SPLITFUSION_LIB_SEGMENTATION_NETWORK_TENSOR_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace splitfusion {

/// An output of a network: a dense 32-bit array of any number of dimensions.
struct NetworkTensor {
  std::string name;  ///< Of the output.
  cv::Mat data;      ///< 32FC1, continuous.
};

/// Length of the last `dimensions` dimensions if all before are 1 (the batch);
/// else of all of them.
std::vector<int> ShapeOf(const cv::Mat& tensor, std::size_t dimensions);

/// "1x116x6300".
std::string ShapeText(const std::vector<int>& shape);

/// Checks the shape of an output, batch aside, and returns it; an expected
/// length of -1 fits any.
///
/// @throw InputError "output 'loc' is 1x4x100: expected ..." unless it fits.
std::vector<int> CheckShape(const NetworkTensor& tensor,
                            const std::vector<int>& expected,
                            const std::string& expected_text);

/// The tensor as a matrix over the same memory.
cv::Mat AsMatrix(const cv::Mat& tensor, int rows);

/// Probability of every pixel of the prototypes to be of an instance,
/// sigmoid(sum over m of coefficients[m] * prototypes[m]), HxW 32FC1.
///
/// @param prototypes M x (H * W) 32FC1.
/// @param coefficients M values.
/// @param size W and H of the prototypes.
cv::Mat MaskProbability(const cv::Mat& prototypes,
                        const std::vector<float>& coefficients, cv::Size size);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SEGMENTATION_NETWORK_TENSOR_H_
