#include "splitfusion/lib/segmentation/yolact_decoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "segmentation/naive_resize.h"
#include "splitfusion/lib/segmentation/yolact_priors.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(YolactPriors, AreThoseOfTheNetworkWith550Pixels) {
  const std::vector<CenterBox> priors = YolactPriors(550);
  ASSERT_EQ(priors.size(), 19248u);  // 3 (69^2 + 35^2 + 18^2 + 9^2 + 5^2)
  EXPECT_FLOAT_EQ(priors[0].cx, 0.5f / 69);
  EXPECT_FLOAT_EQ(priors[0].w, 24.0f / 550);
  EXPECT_FLOAT_EQ(priors[1].w, 24.0f / 550 * std::sqrt(0.5f));
  EXPECT_FLOAT_EQ(priors[1].h, priors[1].w);  // As it was trained.
  EXPECT_FLOAT_EQ(priors[2].w, 24.0f / 550 * std::sqrt(2.0f));
  // Columns before rows: cell (2, 1) of the first level.
  EXPECT_FLOAT_EQ(priors[3 * (69 + 2)].cx, 2.5f / 69);
  EXPECT_FLOAT_EQ(priors[3 * (69 + 2)].cy, 1.5f / 69);
  // First of the second level; last of all.
  EXPECT_FLOAT_EQ(priors[3 * 69 * 69].cx, 0.5f / 35);
  EXPECT_FLOAT_EQ(priors[3 * 69 * 69].w, 48.0f / 550);
  EXPECT_FLOAT_EQ(priors.back().cy, 4.5f / 5);
  EXPECT_FLOAT_EQ(priors.back().w, 384.0f / 550 * std::sqrt(2.0f));
}

TEST(YolactPriors, OtherInputsHaveWholePixelScales) {
  // yolact_im400: 50, 25, 13, 7, 4 cells, int(24 / 550 * 400) = 17 pixels.
  const std::vector<CenterBox> priors = YolactPriors(400);
  EXPECT_EQ(priors.size(), 3u * (2500 + 625 + 169 + 49 + 16));
  EXPECT_FLOAT_EQ(priors[0].w, 17.0f / 400);
}

TEST(DecodeYolactBox, AppliesTheVariances) {
  const float location[] = {2.0f, -1.0f, 1.0f, -3.0f};
  const cv::Rect2f box = DecodeYolactBox({0.5f, 0.4f, 0.2f, 0.1f}, location);
  const float w = 0.2f * std::exp(0.2f);
  const float h = 0.1f * std::exp(-0.6f);
  EXPECT_FLOAT_EQ(box.width, w);
  EXPECT_FLOAT_EQ(box.height, h);
  EXPECT_FLOAT_EQ(box.x + box.width / 2, 0.54f);
  EXPECT_FLOAT_EQ(box.y + box.height / 2, 0.39f);
}

TEST(FastNms, SuppressedBoxesSuppressToo) {
  // Each overlaps the next by 7 / 13; the first and the third by 4 / 16.
  const std::vector<cv::Rect2f> chain = {
      {0, 0, 10, 1}, {3, 0, 10, 1}, {6, 0, 10, 1}};
  EXPECT_EQ(FastNms(chain, 0.5), (std::vector<int>{0}));
  EXPECT_EQ(FastNms(chain, 0.54), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(FastNms({chain[0], chain[2]}, 0.5), (std::vector<int>{0, 1}));
}

/// Outputs for an input of 32x32, 69 priors, two classes, two prototypes of
/// 8x8 like those of the other decoder's test; nothing is detected yet.
class YolactDecoderTest : public testing::Test {
 protected:
  YolactDecoderTest() {
    outputs_[0] = {"loc", Tensor({1, 69, 4})};
    outputs_[1] = {"conf", Tensor({1, 69, 3})};
    outputs_[2] = {"mask", Tensor({1, 69, 2})};
    outputs_[3] = {"proto", Tensor({8, 8, 2})};
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x) {
        outputs_[3].data.at<float>(y, x, 0) = static_cast<float>(x - 3);
        outputs_[3].data.at<float>(y, x, 1) = static_cast<float>(y - 2);
      }
    }
    for (int p = 0; p < 69; ++p) outputs_[1].data.at<float>(0, p, 0) = 1;
  }

  static cv::Mat Tensor(const std::vector<int>& shape) {
    return cv::Mat(shape, CV_32F, cv::Scalar(0));
  }

  /// Makes a prior detect, with a box given by its corners (0..1).
  void Detect(int prior, const cv::Rect2f& box, float class0, float class1,
              float a, float b) {
    const CenterBox p = YolactPriors(32)[prior];
    float* loc = outputs_[0].data.ptr<float>(0, prior);
    loc[0] = (box.x + box.width / 2 - p.cx) / (0.1f * p.w);
    loc[1] = (box.y + box.height / 2 - p.cy) / (0.1f * p.h);
    loc[2] = std::log(box.width / p.w) / 0.2f;
    loc[3] = std::log(box.height / p.h) / 0.2f;
    float* conf = outputs_[1].data.ptr<float>(0, prior);
    conf[1] = class0;
    conf[2] = class1;
    float* mask = outputs_[2].data.ptr<float>(0, prior);
    mask[0] = a;
    mask[1] = b;
  }

  std::vector<NetworkInstance> Decode(cv::Size frame,
                                      const DecoderOptions& options = {}) {
    return MakeYolactDecoder()->Decode(outputs_, {Stretch(frame, {32, 32}), 2},
                                       options);
  }

  std::vector<NetworkTensor> outputs_{4};
};

TEST_F(YolactDecoderTest, MasksAreCroppedInPrototypesAndInterpolated) {
  Detect(40, {0.22f, 0.10f, 0.5f, 0.5f}, 0.1f, 0.8f, 1.0f, 0.6f);
  const std::vector<NetworkInstance> found = Decode({64, 48});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].class_index, 1);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].score), 0.8f);
  EXPECT_NEAR(found[0].box.x, 14.08, 1e-4);
  EXPECT_NEAR(found[0].box.y, 4.8, 1e-4);
  EXPECT_NEAR(found[0].box.br().x, 46.08, 1e-4);
  EXPECT_NEAR(found[0].box.br().y, 28.8, 1e-4);
  // With a margin of 1 the box is [0.76, 6.76) x [-0.2, 5.8) in prototypes.
  cv::Mat_<float> probability = cv::Mat_<float>::zeros(8, 8);
  for (int y = 0; y < 6; ++y) {
    for (int x = 1; x < 7; ++x) {
      const double sum = 1.0 * (x - 3) + 0.6 * (y - 2);
      probability(y, x) = static_cast<float>(1 / (1 + std::exp(-sum)));
    }
  }
  ExpectMaskOf(NaiveResize(probability, {64, 48}), found[0].mask);
}

TEST_F(YolactDecoderTest, EveryClassOfAPriorIsJudgedOnItsOwn) {
  Detect(10, {0.1f, 0.1f, 0.4f, 0.4f}, 0.5f, 0.45f, 1, 1);
  Detect(11, {0.1f, 0.1f, 0.4f, 0.4f}, 0.6f, 0.30f, 1, 1);
  Detect(20, {0.6f, 0.6f, 0.3f, 0.3f}, 0.04f, 0.03f, 1, 1);
  const std::vector<NetworkInstance> found = Decode({64, 48}, {0.02, 0.5, 9});
  ASSERT_EQ(found.size(), 2u);  // The last is below 0.05 in both classes.
  EXPECT_EQ(found[0].class_index, 0);
  EXPECT_FLOAT_EQ(static_cast<float>(found[0].score), 0.6f);
  EXPECT_EQ(found[1].class_index, 1);
  EXPECT_FLOAT_EQ(static_cast<float>(found[1].score), 0.45f);
  EXPECT_EQ(Decode({64, 48}, {0.55, 0.5, 9}).size(), 1u);
  EXPECT_EQ(Decode({64, 48}, {0.02, 0.5, 1}).size(), 1u);
  EXPECT_EQ(Decode({64, 48}, {0.02, 1.0, 9}).size(), 4u);
}

TEST_F(YolactDecoderTest, NamesOutputsOfAnotherShape) {
  outputs_[1].data = Tensor({1, 69, 81});
  ExpectInputError(
      [&] {
        Decode({64, 48});
      },
      "output 'conf' is 1x69x81: expected 1x69x3, background and "
      "2 classes");
  outputs_[2].data = Tensor({1, 69, 32});
  outputs_[1].data = Tensor({1, 69, 3});
  ExpectInputError(
      [&] {
        Decode({64, 48});
      },
      "output 'mask' is 1x69x32: expected 1x69x2");
  outputs_[0].data = Tensor({1, 19248, 4});
  ExpectInputError(
      [&] {
        Decode({64, 48});
      },
      "output 'loc' is 1x19248x4: expected 1x69x4 for an input "
      "of 32x32");
}

TEST(YolactDecoder, InputIsNormalisedRgb) {
  const auto decoder = MakeYolactDecoder();
  const cv::Mat color(48, 64, CV_8UC3, cv::Scalar(0, 116, 255));
  const cv::Mat input =
      decoder->MakeInput(color, decoder->Place(color.size(), {550, 550}));
  ASSERT_EQ(ShapeText(ShapeOf(input, 4)), "1x3x550x550");
  const auto at = [&](int channel) {
    const int index[] = {0, channel, 300, 17};
    return input.at<float>(index);
  };
  EXPECT_NEAR(at(0), (255 - 123.68) / 58.40, 1e-5);
  EXPECT_NEAR(at(1), (116 - 116.78) / 57.12, 1e-5);
  EXPECT_NEAR(at(2), (0 - 103.94) / 57.38, 1e-5);
  ExpectInputError(
      [&] {
        decoder->CheckInputSize({550, 480});
      },
      "input size = 550x480: expected a square");
}

}  // namespace
}  // namespace splitfusion
