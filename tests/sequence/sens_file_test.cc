#include "splitfusion/lib/sequence/sens_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// The bytes of a recording, made piece by piece.
struct SensBytes {
  std::string text;

  template <typename Number>
  void Add(Number value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void AddMatrix(float f, float cx, float cy, float x) {
    const float matrix[16] = {f, 0, cx, x, 0, f, cy, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    for (const float element : matrix) Add(element);
  }
  void AddIntrinsics(float f, float cx, float cy) { AddMatrix(f, cx, cy, 0); }
  void AddPose(float x) { AddMatrix(1, 0, 0, x); }
  void AddBytes(const std::vector<uchar>& bytes) {
    text.append(bytes.begin(), bytes.end());
  }
};

std::vector<uchar> Packed(const cv::Mat& depth) {
  std::vector<uchar> packed(compressBound(2 * depth.total()));
  uLongf size = packed.size();
  compress(packed.data(), &size, depth.data, 2 * depth.total());
  packed.resize(size);
  return packed;
}

class Sens : public ::testing::Test {
 protected:
  static constexpr std::size_t kHeader = 4 + 8 + 4 + 4 * 64 + 8 + 16 + 4 + 8;

  void SetUp() override {
    bytes_.Add(std::uint32_t{4});
    bytes_.Add(std::uint64_t{4});
    bytes_.text += "test";
    bytes_.AddIntrinsics(100, 64, 48);
    bytes_.AddPose(-0.02f);
    bytes_.AddIntrinsics(50, 32, 24);
    bytes_.AddPose(0);
    for (const int value : {2, 1, 128, 96, 64, 48}) bytes_.Add(value);
    bytes_.Add(1000.0f);
    bytes_.Add(std::uint64_t{2});
    ASSERT_EQ(bytes_.text.size(), kHeader);
    for (int i = 0; i < 2; ++i) AddFrame(i);
    Write();
  }

  void AddFrame(int i) {
    const cv::Mat color(96, 128, CV_8UC3, cv::Scalar(10 * (i + 1), 20, 30));
    const cv::Mat depth(48, 64, CV_16UC1, cv::Scalar(1000 * (i + 1)));
    bytes_.AddPose(static_cast<float>(i));
    bytes_.Add(std::uint64_t{0});
    bytes_.Add(std::uint64_t{0});
    std::vector<uchar> jpeg;
    cv::imencode(".jpg", color, jpeg);
    const std::vector<uchar> packed = Packed(depth);
    bytes_.Add(std::uint64_t{jpeg.size()});
    bytes_.Add(std::uint64_t{packed.size()});
    bytes_.AddBytes(jpeg);
    bytes_.AddBytes(packed);
  }

  void Write() { std::ofstream(Path(), std::ios::binary) << bytes_.text; }
  std::string Path() const { return folder_ / "scene0000_00.sens"; }
  void ExpectRefused(const std::string& message) {
    Write();
    ExpectInputError(
        [&] {
          ImageFolderReader reader(Path());
          while (reader.Next()) {
          }
        },
        "scene0000_00.sens" + message);
  }

  TemporaryFolder folder_;
  SensBytes bytes_;
};

TEST_F(Sens, IsRecognisedAndReadAsAFolderWouldBe) {
  ImageFolderReader reader(Path());
  EXPECT_EQ(reader.options().format, "sens");
  EXPECT_EQ(reader.camera().width, 64);
  EXPECT_EQ(reader.camera().fx, 50);
  ASSERT_TRUE(reader.calibration().color);
  EXPECT_EQ(reader.calibration().color->width, 128);
  EXPECT_NEAR(reader.calibration().color->color_from_depth.translation().x(),
              0.02, 1e-8);
  EXPECT_NO_THROW(reader.CheckFrames());
  ASSERT_EQ(reader.size(), 2);
  for (int i = 0; i < 2; ++i) {
    const Frame frame = *reader.Next();
    EXPECT_EQ(frame.stem, "00000" + std::to_string(i));
    EXPECT_DOUBLE_EQ(frame.timestamp, i / 30.0);
    EXPECT_EQ(frame.color.size(), cv::Size(128, 96));
    EXPECT_NEAR(frame.color.at<cv::Vec3b>(50, 60)[0], 10 * (i + 1), 3);
    EXPECT_FLOAT_EQ(frame.depth.at<float>(20, 30), i + 1.0f);
  }
  const Trajectory poses = reader.FindSequencePoses();
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].world_from_camera.translation().x(), 1);
}

TEST_F(Sens, WhatIsNoneIsNamed) {
  const std::string whole = bytes_.text;
  bytes_.text = "";
  ExpectRefused(": 0 bytes that are no .sens file");
  bytes_.text = whole.substr(0, 200);
  ExpectRefused(": 200 bytes that are no .sens file");
  bytes_.text = whole.substr(0, whole.size() - 1);
  ExpectRefused(": " + std::to_string(whole.size() - 1) + " bytes that are no");
  bytes_.text = whole;
  bytes_.text[0] = 3;  // The version.
  ExpectRefused(": " + std::to_string(whole.size()) + " bytes that are no");
  bytes_.text = whole;
  bytes_.text.replace(4, 8, 8, '\xff');  // The length of a name.
  ExpectRefused(": " + std::to_string(whole.size()) + " bytes that are no");
  bytes_.text = whole;
  bytes_.text.replace(kHeader - 8, 8, 8, '\x7f');  // The number of frames.
  ExpectRefused(": " + std::to_string(whole.size()) + " bytes that are no");
  bytes_.text = whole;
  bytes_.text.replace(kHeader - 8, 8, 8, '\0');
  ExpectRefused(": 0 frames");
  ReaderOptions options;
  options.format = "sens";
  ExpectInputError([&] { ImageFolderReader(folder_ / "no.sens", options); },
                   "no.sens: no such file");
}

TEST_F(Sens, ACompressionThatIsNotKnownIsNamed) {
  bytes_.text[kHeader - 8 - 4 - 16 - 4] = 2;  // Of depth.
  ExpectRefused(": compression 2 of colour, 2 of depth: expected jpeg");
}

TEST_F(Sens, BrokenImagesAreNamed) {
  const std::string whole = bytes_.text;
  bytes_.text[whole.size() - 2] ^= 0x55;  // The check sum of zlib.
  ExpectRefused(": frame 1: depth of");
  bytes_.text = whole;
  bytes_.text.replace(kHeader + 64 + 32, 200, 200, 'x');  // The first JPEG.
  ExpectRefused(": frame 0: ");
}

}  // namespace
}  // namespace splitfusion
