#include "splitfusion/lib/tracking/feature_network.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/expect_input_error.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/tiny_onnx.h"

namespace splitfusion {
namespace {

/// What is seen is moved by a way of eights of pixels.
cv::Mat_<std::uint8_t> Dots(const cv::Size& size, const cv::Point& way) {
  cv::Mat_<std::uint8_t> image(size + cv::Size(128, 128));
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image(cv::Rect(cv::Point(64, 64) - way, size)).clone();
}

class FeatureNetworkTest : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_TINY_ONNX(); }

  TemporaryFolder folder_;
};

TEST_F(FeatureNetworkTest, FindsWhatMoved) {
  FeatureNetwork network(MakeTinyOnnx("xfeat", folder_ / "xfeat.onnx"));
  const cv::Point way(16, -8);
  const ImageFeatures before = network.Find(Dots({96, 64}, {0, 0}), 0.05);
  const ImageFeatures now = network.Find(Dots({96, 64}, way), 0.05);
  ASSERT_GT(before.pixels.size(), 40u);
  ASSERT_EQ(before.descriptors.rows, static_cast<int>(before.pixels.size()));
  for (int row = 0; row < before.descriptors.rows; ++row) {
    EXPECT_NEAR(cv::norm(before.descriptors.row(row)), 1, 1e-5);
  }
  const auto alike = AlikeFeatures(before, now, {80, 1, 0.95});
  int right = 0;
  for (const auto& [i, j] : alike) {
    const cv::Vec2f moved = now.pixels[j] - before.pixels[i];
    right += moved == cv::Vec2f(16, -8);
  }
  EXPECT_GT(right, 20);
  EXPECT_GT(right, 0.9 * static_cast<double>(alike.size()));
}

TEST_F(FeatureNetworkTest, PixelsAreThoseOfTheFrame) {
  FeatureNetwork network(MakeTinyOnnx("xfeat", folder_ / "xfeat.onnx"));
  cv::Mat_<std::uint8_t> image(128, 192, std::uint8_t{40});
  image(cv::Rect(100, 60, 2, 2)) = 250;
  const ImageFeatures found = network.Find(image, 0.05);
  ASSERT_EQ(found.pixels.size(), 1u);
  EXPECT_EQ(found.pixels[0], cv::Vec2f(100.5f, 60.5f));
}

TEST_F(FeatureNetworkTest, RefusesOtherNetworks) {
  const auto refused = [&](const std::string& kind, const std::string& text) {
    const std::string path = MakeTinyOnnx(kind, folder_ / (kind + ".onnx"));
    ExpectInputError([&] { FeatureNetwork network(path); }, text);
  };
  refused("yolov8seg", "expected 1x1xHxW, one image");
  refused("gray", "no output 'keypoint_logits'");
  ExpectInputError([&] { FeatureNetwork network(folder_ / "none.onnx"); },
                   "none.onnx: cannot be opened: expected an ONNX file");
}

TEST(FeaturesWithin, AreThoseOfTheMask) {
  ImageFeatures features;
  features.pixels = {{1.6f, 0}, {3, 2}, {9, 9}};
  features.descriptors = cv::Mat_<float>::eye(3, 3);
  cv::Mat_<std::uint8_t> mask(4, 4, std::uint8_t{0});
  mask(0, 2) = mask(1, 1) = 255;
  const ImageFeatures within = FeaturesWithin(features, mask);
  ASSERT_EQ(within.pixels.size(), 1u);
  EXPECT_EQ(within.pixels[0], features.pixels[0]);
  EXPECT_EQ(within.descriptors(0, 0), 1);
}

}  // namespace
}  // namespace splitfusion
