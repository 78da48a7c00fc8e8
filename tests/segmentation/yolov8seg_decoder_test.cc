#include "splitfusion/lib/segmentation/yolov8seg_decoder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "segmentation/naive_resize.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

constexpr int kClasses = 3;
constexpr int kPrototypes = 2;

/// cx, cy, w, h; three classes; two coefficients.
using Anchor = std::array<float, 4 + kClasses + kPrototypes>;

/// Outputs for an input of 64x32 whose prototypes are 16x8: prototype 0 grows
/// from left (-4) to right, prototype 1 from top to bottom.
std::vector<NetworkTensor> MakeOutputs(const std::vector<Anchor>& anchors) {
  std::vector<NetworkTensor> outputs(2);
  const int rows = 4 + kClasses + kPrototypes;
  const int columns = static_cast<int>(anchors.size());
  outputs[0] = {"output0", cv::Mat(std::vector<int>{1, rows, columns}, CV_32F)};
  for (int row = 0; row < rows; ++row) {
    for (int a = 0; a < columns; ++a) {
      outputs[0].data.at<float>(0, row, a) = anchors[a][row];
    }
  }
  outputs[1] = {"output1",
                cv::Mat(std::vector<int>{1, kPrototypes, 8, 16}, CV_32F)};
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const int p0[] = {0, 0, y, x};
      const int p1[] = {0, 1, y, x};
      outputs[1].data.at<float>(p0) = 0.5f * static_cast<float>(x - 8);
      outputs[1].data.at<float>(p1) = 0.5f * static_cast<float>(y - 4);
    }
  }
  return outputs;
}

std::vector<NetworkInstance> Decode(const std::vector<NetworkTensor>& outputs,
                                    const DecoderInput& input,
                                    const DecoderOptions& options) {
  return MakeYolov8SegDecoder()->Decode(outputs, input, options);
}

DecoderInput InputFor(cv::Size frame) {
  return {Letterbox(frame, {64, 32}), kClasses};
}

/// Probability of the prototypes by the formula, for coefficients a and b.
cv::Mat_<float> Probability(double a, double b) {
  cv::Mat_<float> probability(8, 16);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double sum = a * 0.5 * (x - 8) + b * 0.5 * (y - 4);
      probability(y, x) = static_cast<float>(1 / (1 + std::exp(-sum)));
    }
  }
  return probability;
}

TEST(Yolov8SegDecoder, MasksAreTheSigmoidOfPrototypesCutByTheirBox) {
  const std::vector<NetworkTensor> outputs =
      MakeOutputs({{30, 16, 40, 20, 0.1f, 0.7f, 0.2f, 1.0f, -0.7f}});
  const std::vector<NetworkInstance> found =
      Decode(outputs, InputFor({128, 64}), {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].class_index, 1);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].score), 0.7f);
  EXPECT_EQ(found[0].box, cv::Rect2d(20, 12, 80, 40));  // Twice 10, 6, 40, 20.
  cv::Mat_<float> expected = NaiveResize(Probability(1.0, -0.7), {128, 64});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      if (x < 20 || x >= 100 || y < 12 || y >= 52) expected(y, x) = 0;
    }
  }
  ExpectMaskOf(expected, found[0].mask);
}

TEST(Yolov8SegDecoder, LetterboxedFramesGetTheirPartOfTheMask) {
  const std::vector<NetworkTensor> outputs =
      MakeOutputs({{32, 16, 64, 32, 0.9f, 0, 0, 1.0f, 0.3f}});
  const std::vector<NetworkInstance> found =
      Decode(outputs, InputFor({50, 50}), {});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].box, cv::Rect2d(0, 0, 50, 50));
  const cv::Mat_<float> input = NaiveResize(Probability(1.0, 0.3), {64, 32});
  ExpectMaskOf(NaiveResize(input(cv::Rect(16, 0, 32, 32)).clone(), {50, 50}),
               found[0].mask);
}

TEST(Yolov8SegDecoder, SuppressesDoublesWithinAClassOnly) {
  const std::vector<NetworkTensor> outputs = MakeOutputs({
      {20, 16, 20, 20, 0.6f, 0, 0, 1, 0},
      {22, 16, 20, 20, 0.8f, 0, 0, 1, 0},  // IoU with the first 18 / 22.
      {22, 16, 20, 20, 0, 0.7f, 0, 1, 0},  // Another class.
      {50, 16, 20, 20, 0.5f, 0, 0, 1, 0},  // Another place.
      {50, 16, 20, 20, 0.2f, 0.1f, 0, 1, 0},
  });
  const std::vector<NetworkInstance> found =
      Decode(outputs, InputFor({64, 32}), {});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].score), 0.8f);
  EXPECT_EQ(found[0].class_index, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(found[1].score), 0.7f);
  EXPECT_EQ(found[1].class_index, 1);
  EXPECT_EQ(found[2].box, cv::Rect2d(40, 6, 20, 20));
}

TEST(Yolov8SegDecoder, OptionsChooseWhatIsKept) {
  const std::vector<NetworkTensor> outputs = MakeOutputs({
      {20, 16, 20, 20, 0.6f, 0, 0, 1, 0},
      {22, 16, 20, 20, 0.8f, 0, 0, 1, 0},
      {50, 16, 20, 20, 0.2f, 0, 0, 1, 0},
  });
  const auto count = [&](const DecoderOptions& options) {
    return Decode(outputs, InputFor({64, 32}), options).size();
  };
  EXPECT_EQ(count({0.1, 0.5, 100}), 2u);
  EXPECT_EQ(count({0.7, 0.5, 100}), 1u);
  EXPECT_EQ(count({0.1, 0.9, 100}), 3u);
  EXPECT_EQ(count({0.1, 0.9, 1}), 1u);
}

TEST(Yolov8SegDecoder, NamesOutputsOfAnotherShape) {
  std::vector<NetworkTensor> outputs = MakeOutputs({Anchor{}, Anchor{}});
  DecoderInput input = InputFor({64, 32});
  input.classes = 80;
  ExpectInputError([&] { Decode(outputs, input, {}); },
                   "output 'output0' is 1x9x2: expected 1x86xN, a box, 80 "
                   "classes");
  input.classes = kClasses;
  input.placement.input = {64, 64};
  ExpectInputError([&] { Decode(outputs, input, {}); },
                   "output 'output1' is 1x2x8x16: expected 1xMx16x16");
}

TEST(Yolov8SegDecoder, InputIsRgbOfUnitRangeOnGrey) {
  const auto decoder = MakeYolov8SegDecoder();
  const cv::Mat color(32, 32, CV_8UC3, cv::Scalar(51, 102, 255));
  const cv::Mat input =
      decoder->MakeInput(color, decoder->Place({32, 32}, {64, 32}));
  ASSERT_EQ(ShapeText(ShapeOf(input, 4)), "1x3x32x64");
  const auto at = [&](int channel, int column) {
    const int index[] = {0, channel, 7, column};
    return input.at<float>(index);
  };
  EXPECT_FLOAT_EQ(at(0, 30), 1.0f);
  EXPECT_FLOAT_EQ(at(1, 30), 0.4f);
  EXPECT_FLOAT_EQ(at(2, 30), 0.2f);
  EXPECT_FLOAT_EQ(at(0, 3), 114 / 255.0f);
  ExpectInputError(
      [&] {
        decoder->CheckInputSize({640, 470});
      },
      "input size = 640x470: expected multiples of 32");
}

TEST(BuiltinDecoders, AreBothAndNamed) {
  EXPECT_EQ(BuiltinDecoders().Make("yolov8seg")->OutputNames(),
            (std::vector<std::string>{"output0", "output1"}));
  EXPECT_EQ(BuiltinDecoders().Make("yolact")->DefaultInputSize(),
            cv::Size(550, 550));
  ExpectInputError([] { BuiltinDecoders().Make("mask_rcnn"); },
                   "decoder = mask_rcnn: expected yolact or yolov8seg");
}

TEST(DecoderOptions, NamesFieldAndBound) {
  ExpectInputError(
      [] {
        DecoderOptions{1.5, 0.5, 100}.Check();
      },
      "score_threshold = 1.5: expected 0..1");
  ExpectInputError(
      [] {
        DecoderOptions{0.5, 0, 100}.Check();
      },
      "nms_threshold = 0: expected above 0");
  ExpectInputError(
      [] {
        DecoderOptions{0.5, 0.5, 0}.Check();
      },
      "top_k = 0: expected >= 1");
}

}  // namespace
}  // namespace splitfusion
