#include "splitfusion/lib/sequence/ros_bag.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

template <typename Number>
std::string Bytes(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

/// After its length.
std::string Sized(const std::string& bytes) {
  return Bytes(static_cast<std::uint32_t>(bytes.size())) + bytes;
}

std::string Field(const std::string& name, const std::string& value) {
  return Sized(name + "=" + value);
}

std::string Record(const std::string& header, const std::string& data) {
  return Sized(header) + Sized(data);
}

std::string Connection(std::uint32_t id, const std::string& topic,
                       const std::string& type) {
  return Record(
      Field("op", "\x07") + Field("conn", Bytes(id)) + Field("topic", topic),
      Field("topic", topic) + Field("type", type));
}

std::string Message(std::uint32_t connection, const std::string& data) {
  return Record(Field("op", "\x02") + Field("conn", Bytes(connection)) +
                    Field("time", std::string(8, '\0')),
                data);
}

std::string Chunk(const std::string& records,
                  const std::string& compression = "none") {
  return Record(
      Field("op", "\x05") + Field("compression", compression) +
          Field("size", Bytes(static_cast<std::uint32_t>(records.size()))),
      records);
}

/// A header whose time stamp is `time` tenths of a second.
std::string Header(int time) {
  return Bytes(std::uint32_t{0}) + Bytes(std::uint32_t{100}) +
         Bytes(static_cast<std::uint32_t>(time * 100000000)) + Sized("camera");
}

std::string Image(int time, const cv::Mat& image, const std::string& encoding) {
  const auto step = static_cast<std::uint32_t>(image.cols * image.elemSize());
  return Header(time) + Bytes(static_cast<std::uint32_t>(image.rows)) +
         Bytes(static_cast<std::uint32_t>(image.cols)) + Sized(encoding) +
         Bytes(std::uint8_t{0}) + Bytes(step) +
         Sized({reinterpret_cast<const char*>(image.data),
                image.total() * image.elemSize()});
}

std::string Compressed(int time, const cv::Mat& image,
                       const std::string& extension, const std::string& format,
                       const std::string& before = "") {
  std::vector<uchar> bytes;
  cv::imencode(extension, image, bytes);
  return Header(time) + Sized(format) +
         Sized(before + std::string(bytes.begin(), bytes.end()));
}

std::string CameraInfo(double fx, const std::string& model = "plumb_bob") {
  std::string text = Header(0) + Bytes(std::uint32_t{48}) +
                     Bytes(std::uint32_t{64}) + Sized(model) +
                     Bytes(std::uint32_t{5});
  for (const double d : {0.25, 0.0, 0.0, 0.0, 0.0}) text += Bytes(d);
  for (const double k : {fx, 0.0, 31.5, 0.0, fx, 23.5, 0.0, 0.0, 1.0}) {
    text += Bytes(k);
  }
  return text + std::string(21 * 8 + 30, '\0');
}

cv::Mat Color(int i) {
  return {48, 64, CV_8UC3, cv::Scalar(30, 20, 10 * (i + 1))};  // As RGB.
}
cv::Mat Depth(int i) { return {48, 64, CV_16UC1, cv::Scalar(1000 * (i + 1))}; }

class RosBags : public ::testing::Test {
 protected:
  void Write(const std::string& records) {
    std::ofstream(Path(), std::ios::binary)
        << "#ROSBAG V2.0\n"
        << Record(Field("op", "\x03"), std::string(20, ' ')) << records;
  }
  std::string Path() const { return folder_ / "take.bag"; }
  void ExpectTwoFrames() {
    ImageFolderReader reader(Path());
    EXPECT_EQ(reader.options().format, "rosbag");
    EXPECT_NO_THROW(reader.CheckFrames());
    ASSERT_EQ(reader.size(), 2);
    for (int i = 0; i < 2; ++i) {
      const Frame frame = *reader.Next();
      EXPECT_NEAR(frame.timestamp, 100 + 0.1 * i, 1e-6);
      EXPECT_NEAR(frame.color.at<cv::Vec3b>(24, 32)[0], 10 * (i + 1), 3);
      EXPECT_FLOAT_EQ(frame.depth.at<float>(24, 32), i + 1.0f);
    }
  }
  void ExpectRefused(const std::string& message) {
    ExpectInputError(
        [&] {
          ImageFolderReader reader(Path());
          while (reader.Next()) {
          }
        },
        message);
  }

  TemporaryFolder folder_;
};

TEST_F(RosBags, RegisteredDepthHasTheColourCameraAndItsLens) {
  std::string records =
      Connection(0, "/camera/depth/image_raw", "sensor_msgs/Image") +
      Connection(1, "/camera/depth_registered/image_raw", "sensor_msgs/Image") +
      Connection(2, "/camera/rgb/image_color", "sensor_msgs/Image") +
      Connection(3, "/camera/rgb/camera_info", "sensor_msgs/CameraInfo") +
      Connection(4, "/tf", "tf/tfMessage") + Message(3, CameraInfo(50)) +
      Message(0, Image(0, Depth(7), "16UC1")) + Message(4, "whatever");
  for (int i = 0; i < 2; ++i) {
    records += Message(1, Image(i, Depth(i), "16UC1")) +
               Message(2, Image(i, Color(i), "rgb8"));
  }
  Write(Chunk(records));
  ExpectTwoFrames();
  const ImageFolderReader reader(Path());
  EXPECT_EQ(reader.camera().fx, 50);
  EXPECT_EQ(reader.camera().width, 64);
  EXPECT_EQ(reader.calibration().lens.coefficients[0], 0.25);
}

TEST_F(RosBags, ImagesMayBeCompressedAndDepthInMetres) {
  const std::string color = "/camera/color/image_raw/compressed";
  const std::string connections =
      Connection(2, color, "sensor_msgs/CompressedImage") +
      Connection(3, "/camera/depth/camera_info", "sensor_msgs/CameraInfo") +
      Message(3, CameraInfo(50));
  const auto color_of = [](int i) {
    cv::Mat bgr(48, 64, CV_8UC3, cv::Scalar(10 * (i + 1), 20, 30));
    return Message(2, Compressed(i, bgr, ".jpg", "rgb8; jpeg compressed bgr8"));
  };
  std::string records = connections;
  records += Connection(1, "/camera/depth/image/compressedDepth",
                        "sensor_msgs/CompressedImage");
  for (int i = 0; i < 2; ++i) {
    records += color_of(i) + Message(1, Compressed(i, Depth(i), ".png",
                                                   "16UC1; compressedDepth png",
                                                   std::string(12, '\1')));
  }
  Write(Chunk(records));
  ExpectTwoFrames();
  records = connections +
            Connection(1, "/camera/depth/image_raw", "sensor_msgs/Image");
  for (int i = 0; i < 2; ++i) {
    const cv::Mat metres(48, 64, CV_32FC1, cv::Scalar(i + 1));
    records += color_of(i) + Message(1, Image(i, metres, "32FC1"));
  }
  Write(Chunk(records));
  ExpectTwoFrames();
}

TEST_F(RosBags, WhatIsNoneIsNamed) {
  folder_.Write("take.bag", "#ROSBAG V1.2\n");
  ExpectRefused("take.bag: 13 bytes that are no .bag of ROS 1");
  Write("");
  ExpectRefused("take.bag: no images of depth and colour");
  const std::string chunk =
      Chunk(Connection(0, "/depth/image", "sensor_msgs/Image") +
            Connection(1, "/rgb/image", "sensor_msgs/Image") +
            Message(0, Image(0, Depth(0), "16UC1")) +
            Message(1, Image(5, Color(0), "rgb8")));
  Write(chunk.substr(0, chunk.size() - 1));
  ExpectRefused("that are no .bag of ROS 1, version 2.0, or a truncated one");
  Write(chunk);
  ExpectRefused("take.bag: 0 frames: expected colour and depth within");
  Write(Chunk("xxxx", "bz2"));
  ExpectRefused("take.bag: compressed by bz2: expected none, as after 'rosbag");
  Write(Message(7, "of no connection"));
  ExpectRefused("that are no .bag of ROS 1");
}

TEST_F(RosBags, BrokenMessagesAreNamed) {
  const auto write = [&](const std::string& depth, const std::string& info) {
    Write(Chunk(Connection(0, "/depth/image", "sensor_msgs/Image") +
                Connection(1, "/rgb/image", "sensor_msgs/Image") +
                Connection(2, "/depth/camera_info", "sensor_msgs/CameraInfo") +
                Message(0, depth) + Message(1, Image(0, Color(0), "rgb8")) +
                Message(2, info)));
  };
  const std::string good = Image(0, Depth(0), "16UC1");
  write(good, CameraInfo(50).substr(0, 60));
  ExpectRefused("take.bag: /depth/camera_info, message 0: is truncated");
  write(good, CameraInfo(50, "equidistant"));
  ExpectRefused("message 0: distortion 'equidistant' of 5 coefficients");
  write(good.substr(0, good.size() - 1), CameraInfo(50));
  ExpectRefused("take.bag: /depth/image, message 0: is truncated");
  write(Image(0, Depth(0), "bayer_rggb8"), CameraInfo(50));
  ExpectRefused("encoding 'bayer_rggb8': expected rgb8, bgr8");
  write(Image(0, Color(0), "rgb8"), CameraInfo(50));
  ExpectRefused("an image of another kind: expected colour of 8 bit");
}

}  // namespace
}  // namespace splitfusion
