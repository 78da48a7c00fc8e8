#include "splitfusion/lib/segmentation/network_segmenter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/sequence/image_file.h"
#include "support/expect_input_error.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"
#include "support/tiny_onnx.h"

namespace splitfusion {
namespace {

double Overlap(const cv::Mat& a, const cv::Mat& b) {
  return static_cast<double>(cv::countNonZero(a & b)) / cv::countNonZero(a | b);
}

cv::Mat RectangleMask(cv::Size size, const cv::Rect& inside) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  mask(inside) = 255;
  return mask;
}

/// Blue, with a red rectangle: the tiny networks see "person" in what is red
/// and "dog" in what is blue.
Frame PaintedFrame(cv::Size size, const cv::Rect& red) {
  Frame frame;
  frame.stem = "000000";
  frame.color = cv::Mat(size, CV_8UC3, cv::Scalar(255, 0, 0));
  frame.color(red) = cv::Scalar(0, 0, 255);
  return frame;
}

class NetworkSegmenterTest : public testing::Test {
 protected:
  void SetUp() override { SKIP_WITHOUT_TINY_ONNX(); }

  /// A segmenter on the tiny network of that kind.
  NetworkSegmenter Make(const std::string& kind, const std::string& decoder,
                        cv::Size input_size = {}) {
    NetworkOptions options;
    options.model = MakeTinyOnnx(kind, folder_ / (kind + ".onnx"));
    options.decoder = decoder;
    options.class_names = {"person", "dog"};
    options.input_size = input_size;
    return NetworkSegmenter(options);
  }

  void ExpectRefused(const std::string& kind, const std::string& decoder,
                     const std::string& text, cv::Size input_size = {}) {
    ExpectInputError([&] { Make(kind, decoder, input_size); }, text);
  }

  TemporaryFolder folder_;
};

TEST_F(NetworkSegmenterTest, Yolov8SegFollowsTheImage) {
  NetworkSegmenter segmenter = Make("yolov8seg", "yolov8seg");
  EXPECT_EQ(segmenter.input_size(), cv::Size(96, 64));
  const cv::Size size(192, 128);
  const cv::Rect red(40, 32, 64, 56);
  const std::vector<InstanceMask> found =
      segmenter.Segment(PaintedFrame(size, red));
  ASSERT_EQ(found.size(), 2u);  // Its double and the weak one are dropped.
  EXPECT_EQ(found[0].class_name, "person");
  EXPECT_DOUBLE_EQ(found[0].score, 0.9);
  EXPECT_EQ(found[0].box, cv::Rect2d(0, 0, 144, 128));
  EXPECT_GT(Overlap(found[0].mask, RectangleMask(size, red)), 0.98);
  EXPECT_EQ(found[1].class_name, "dog");
  EXPECT_GT(Overlap(found[1].mask, ~RectangleMask(size, red)), 0.98);
}

TEST_F(NetworkSegmenterTest, YolactFollowsTheImage) {
  NetworkSegmenter segmenter = Make("yolact", "yolact");
  EXPECT_EQ(segmenter.input_size(), cv::Size(64, 64));
  const cv::Size size(160, 80);
  const cv::Rect red(40, 20, 60, 35);
  const std::vector<InstanceMask> found =
      segmenter.Segment(PaintedFrame(size, red));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].class_name, "person");
  EXPECT_DOUBLE_EQ(found[0].score, 0.9);
  EXPECT_GT(Overlap(found[0].mask, RectangleMask(size, red)), 0.95);
  EXPECT_EQ(found[1].class_name, "dog");
  EXPECT_DOUBLE_EQ(found[1].score, 0.6);
}

TEST_F(NetworkSegmenterTest, FramesOfAnyShapeAreLetterboxed) {
  NetworkSegmenter segmenter = Make("yolov8seg", "yolov8seg");
  for (const cv::Size size :
       {cv::Size(320, 80), cv::Size(75, 200), cv::Size(48, 32)}) {
    const cv::Rect red(size.width / 4, size.height / 4, size.width / 4,
                       size.height / 2);
    const std::vector<InstanceMask> found =
        segmenter.Segment(PaintedFrame(size, red));
    ASSERT_GE(found.size(), 1u);
    EXPECT_EQ(found[0].mask.size(), size);
    EXPECT_GT(Overlap(found[0].mask, RectangleMask(size, red)), 0.85) << size;
  }
}

TEST_F(NetworkSegmenterTest, TheInputSizeIsThatOfModelOrOption) {
  EXPECT_EQ(Make("open_size", "yolov8seg", {96, 64}).input_size(),
            cv::Size(96, 64));
  ExpectRefused("yolov8seg", "yolov8seg",
                "input size = 320x320: expected 96x64, the size fixed in",
                {320, 320});
  ExpectInputError(
      [&] {
        Make("open_size", "yolov8seg", {100, 64});
      },
      "input size = 100x64: expected multiples of 32");
}

TEST_F(NetworkSegmenterTest, ResultsDoNotDependOnTheThreads) {
  NetworkSegmenter segmenter = Make("yolov8seg", "yolov8seg");
  Frame frame = PaintedFrame({192, 128}, {40, 32, 64, 56});
  cv::randu(frame.color, 0, 255);
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const std::vector<InstanceMask> once = segmenter.Segment(frame);
  cv::setNumThreads(3);
  const std::vector<InstanceMask> again = segmenter.Segment(frame);
  cv::setNumThreads(threads);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(cv::countNonZero(once[i].mask != again[i].mask), 0);
    EXPECT_EQ(once[i].score, again[i].score);
  }
}

TEST_F(NetworkSegmenterTest, RefusesNetworksThatDoNotFit) {
  ExpectRefused(
      "yolact", "yolov8seg",
      "yolact.onnx: no output 'output0': found loc 1x258x4, conf 1x258x3, mask "
      "1x258x2, proto 1x16x16x2; expected output0, output1");
  ExpectRefused("other_names", "yolov8seg", "found boxes 1x8x4, output1");
  ExpectRefused("half", "yolov8seg", "'half_weight' are FLOAT16: expected");
  ExpectRefused("clip", "yolov8seg", "cannot load the network");
  ExpectRefused("clip", "yolov8seg", "Clip");
  ExpectRefused("gray", "yolov8seg", "input 'images' is 1x1x64x96: expected");
  ExpectRefused("two_inputs", "yolov8seg", "2 inputs: expected one");
  ExpectRefused("yolov8seg", "mask_rcnn", "decoder = mask_rcnn: expected");
}

TEST_F(NetworkSegmenterTest, RefusesClassNamesOfAnotherNetwork) {
  NetworkOptions options;
  options.model = MakeTinyOnnx("yolov8seg", folder_ / "n.onnx");
  options.decoder = "yolov8seg";
  ExpectInputError([&] { NetworkSegmenter segmenter(options); },
                   "n.onnx: output 'output0' is 1x8x4: expected 1x86xN, a "
                   "box, 80 classes");
}

TEST_F(NetworkSegmenterTest, SettingsTellNetworksApart) {
  const auto first = Make("yolov8seg", "yolov8seg").Settings();
  EXPECT_EQ(first, Make("yolov8seg", "yolov8seg").Settings());
  EXPECT_EQ(first.at("input_size"), "96x64");
  EXPECT_EQ(first.at("model"), "yolov8seg.onnx");
  EXPECT_NE(
      first.at("model_content"),
      Make("open_size", "yolov8seg", {96, 64}).Settings().at("model_content"));
}

TEST(OnnxNetwork, RefusesWhatIsNoNetwork) {
  const TemporaryFolder folder;
  ExpectInputError([&] { OnnxNetwork network(folder / "none.onnx"); },
                   "none.onnx: cannot be opened: expected an ONNX file");
  ExpectInputError([&] { OnnxNetwork network(folder / ""); },
                   "cannot be opened");
  for (const char* text : {"", "not a network", "\x3a\x05 abc"}) {
    const std::string path = folder.Write("x.onnx", text);
    ExpectInputError([&] { OnnxNetwork network(path); },
                     "x.onnx: not an ONNX model, or a truncated one");
  }
}

TEST(ClassNames, AreCocosOrThoseOfAFile) {
  const std::vector<std::string>& coco = CocoClassNames();
  ASSERT_EQ(coco.size(), 80u);
  EXPECT_EQ(coco[0], "person");
  EXPECT_EQ(coco[16], "dog");
  EXPECT_EQ(coco[77], "teddy bear");
  const TemporaryFolder folder;
  EXPECT_EQ(ReadClassNames(folder.Write("n.txt", "hand\r\n\nsoft toy \n")),
            (std::vector<std::string>{"hand", "soft toy"}));
  ExpectInputError([&] { ReadClassNames(folder.Write("e.txt", "\n")); },
                   "e.txt: no class names: expected one a line");
  ExpectInputError([&] { ReadClassNames(folder / "no.txt"); },
                   "no.txt: cannot be opened");
}

TEST(RealNetwork, FindsThePersonInAPhotograph) {
  const std::string model = SharedModel("yolov8n-seg_h480_w640.onnx");
  const std::string sequence = SharedData("uva_person_turn");
  SKIP_WITHOUT_SHARED_DATA(model, "models/yolov8n-seg_h480_w640.onnx");
  SKIP_WITHOUT_SHARED_DATA(sequence, "uva_person_turn");
  NetworkOptions options;
  options.model = model;
  options.decoder = "yolov8seg";
  NetworkSegmenter segmenter(options);
  for (const char* stem : {"000000", "000040"}) {
    Frame frame;
    frame.stem = stem;
    frame.color = ReadColorImage(sequence + "/rgb/" + stem + ".jpg");
    const cv::Mat person =
        ReadLabelImage(sequence + "/mask/" + stem + ".png") != 0;
    const std::vector<InstanceMask> found = segmenter.Segment(frame);
    ASSERT_GE(found.size(), 1u);
    EXPECT_EQ(found[0].class_name, "person");
    EXPECT_GT(found[0].score, 0.85);
    EXPECT_GT(Overlap(found[0].mask, person), 0.8);
    // The same photograph at half the size, and with a broad margin.
    cv::resize(frame.color, frame.color, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::copyMakeBorder(frame.color, frame.color, 0, 0, 100, 60,
                       cv::BORDER_CONSTANT, cv::Scalar::all(90));
    const std::vector<InstanceMask> small = segmenter.Segment(frame);
    ASSERT_GE(small.size(), 1u);
    EXPECT_EQ(small[0].class_name, "person");
    cv::Mat scaled;
    cv::resize(found[0].mask, scaled, {}, 0.5, 0.5, cv::INTER_NEAREST);
    cv::copyMakeBorder(scaled, scaled, 0, 0, 100, 60, cv::BORDER_CONSTANT);
    EXPECT_GT(Overlap(small[0].mask, scaled), 0.85);
  }
}

}  // namespace
}  // namespace splitfusion
