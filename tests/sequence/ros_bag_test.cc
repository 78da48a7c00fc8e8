#include "splitfusion/lib/sequence/ros_bag.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

#ifndef SPLITFUSION_WITH_ROSBAG

namespace splitfusion {
namespace {

TEST(RosBags, ABuildWithoutTheLibrarySaysSo) {
  const TemporaryFolder folder;
  const std::string bag = folder.Write("take.bag", "#ROSBAG V2.0\n");
  ExpectInputError([&] { ImageFolderReader reader(bag); },
                   "take.bag: built without librosbag-storage: install "
                   "librosbag-storage-dev and libsensor-msgs-dev and build "
                   "again, or convert it with sf_convert");
}

TEST(RosBags, AreReadAsTheyWereWritten) {
  GTEST_SKIP() << "librosbag-storage not found, or not wanted, by this build";
}

}  // namespace
}  // namespace splitfusion

#else

#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace splitfusion {
namespace {

namespace compression = rosbag::compression;

constexpr char kDepthTopic[] = "/camera/depth/image_raw";
constexpr char kColorTopic[] = "/camera/rgb/image_color";
constexpr char kColorCamera[] = "/camera/rgb/camera_info";

std_msgs::Header Header(int i) {
  std_msgs::Header header;
  header.stamp = ros::Time(100 + 0.1 * i);
  header.frame_id = "camera";
  return header;
}

sensor_msgs::Image ImageMessage(int i, const cv::Mat& image,
                                const std::string& encoding) {
  sensor_msgs::Image message;
  message.header = Header(i);
  message.height = image.rows;
  message.width = image.cols;
  message.encoding = encoding;
  message.step = image.cols * image.elemSize();
  message.data.assign(image.data,
                      image.data + image.total() * image.elemSize());
  return message;
}

sensor_msgs::CompressedImage CompressedMessage(
    int i, const cv::Mat& image, const std::string& extension,
    const std::string& format, const std::vector<std::uint8_t>& before = {}) {
  sensor_msgs::CompressedImage message;
  message.header = Header(i);
  message.format = format;
  cv::imencode(extension, image, message.data);
  message.data.insert(message.data.begin(), before.begin(), before.end());
  return message;
}

sensor_msgs::CameraInfo Camera(double fx,
                               const std::string& model = "plumb_bob",
                               double k1 = 0) {
  sensor_msgs::CameraInfo message;
  message.header = Header(0);
  message.height = 48;
  message.width = 64;
  message.distortion_model = model;
  message.D = {k1, 0, 0, 0, 0};
  message.K = {fx, 0, 31.5, 0, fx, 23.5, 0, 0, 1};
  return message;
}

/// Random numbers of a type, other ones for every seed.
cv::Mat Noise(int type, int seed) {
  cv::Mat image(48, 64, type);
  cv::RNG(seed).fill(image, cv::RNG::UNIFORM, 1, 255);
  return image;
}

/// A plane, millimetres, of which no pixel is taken for a wrong one.
cv::Mat Depth(int seed) {
  cv::Mat image(48, 64, CV_16UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint16_t>(y, x) = 1000 + 7 * seed + x + 2 * y;
    }
  }
  return image;
}

void ExpectSame(const cv::Mat& image, const cv::Mat& expected) {
  ASSERT_EQ(image.type(), expected.type());
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_EQ(cv::norm(image, expected, cv::NORM_INF), 0);
}

class RosBags : public ::testing::Test {
 protected:
  /// Messages are added to it until Close().
  rosbag::Bag& New(
      compression::CompressionType how = compression::Uncompressed) {
    bag_.open(Path(), rosbag::bagmode::Write);
    bag_.setCompression(how);
    return bag_;
  }

  template <typename Message>
  void Add(const std::string& topic, const Message& message) {
    bag_.write(topic, message.header.stamp, message);
  }

  void Close() { bag_.close(); }

  /// Two images each of depth and colour, with a camera of the colour.
  void WriteTwoFrames(compression::CompressionType how) {
    New(how).setChunkThreshold(10000);  // Two images.
    Add(kColorCamera, Camera(50));
    for (int i = 0; i < 2; ++i) {
      Add(kDepthTopic, ImageMessage(i, Depth(i), "16UC1"));
      Add(kColorTopic, ImageMessage(i, Noise(CV_8UC3, i), "bgr8"));
    }
    Close();
  }

  std::string Path() const { return folder_ / "take.bag"; }

  void ReadAll() const {
    ImageFolderReader reader(Path());
    while (reader.Next()) {
    }
  }

  void ExpectRefused(const std::string& message) const {
    ExpectInputError([&] { ReadAll(); }, message);
  }

  /// Expects that after a change of the file.
  void ExpectRefusedWith(std::string bytes, const std::string& message) const {
    folder_.Write("take.bag", bytes);
    ExpectRefused(message);
  }

  TemporaryFolder folder_;

 private:
  rosbag::Bag bag_;
};

/// The bytes with a number in the place of what is at an offset.
template <typename Number>
std::string With(std::string bytes, std::size_t offset, Number number) {
  std::memcpy(&bytes.at(offset), &number, sizeof(number));
  return bytes;
}

/// Where the first `key` ends that does not begin before `from`.
std::size_t After(const std::string& key, const std::string& bytes,
                  std::size_t from = 0) {
  const std::size_t at = bytes.find(key, from);
  EXPECT_NE(at, std::string::npos) << key;
  return at + key.size();
}

TEST_F(RosBags, AreReadAsTheyWereWritten) {
  for (const auto how :
       {compression::Uncompressed, compression::BZ2, compression::LZ4}) {
    WriteTwoFrames(how);
    const std::unique_ptr<RosBag> bag = OpenRosBag(Path());
    EXPECT_EQ(bag->ImageTopics(),
              (std::vector<std::string>{kDepthTopic, kColorTopic}));
    for (int i = 0; i < 2; ++i) {
      ExpectSame(bag->Image(kDepthTopic, i), Depth(i));
      ExpectSame(bag->Image(kColorTopic, i), Noise(CV_8UC3, i));
    }
    ImageFolderReader reader(Path());
    EXPECT_EQ(reader.options().format, "rosbag");
    EXPECT_NO_THROW(reader.CheckFrames());
    EXPECT_EQ(reader.camera().fx, 50);
    ASSERT_EQ(reader.size(), 2);
    for (int i = 0; i < 2; ++i) {
      const Frame frame = *reader.Next();
      EXPECT_NEAR(frame.timestamp, 100 + 0.1 * i, 1e-6);
      ExpectSame(frame.color, Noise(CV_8UC3, i));
      cv::Mat metres;
      Depth(i).convertTo(metres, CV_32FC1, 1 / 1000.0);
      EXPECT_LT(cv::norm(frame.depth, metres, cv::NORM_INF), 1e-6);
    }
  }
}

TEST_F(RosBags, AreSmallerIfCompressed) {
  const auto size = [&](compression::CompressionType how) {
    New(how);
    Add(kDepthTopic, ImageMessage(0, cv::Mat::ones(48, 64, CV_16UC1), "16UC1"));
    Close();
    return folder_.Read("take.bag").size();
  };
  EXPECT_LT(size(compression::BZ2) + 5000, size(compression::Uncompressed));
  EXPECT_LT(size(compression::LZ4) + 5000, size(compression::Uncompressed));
}

TEST_F(RosBags, RegisteredDepthHasTheColourCameraAndItsLens) {
  New().write("/depth/of_another_type", Header(0).stamp, Header(0));
  Add("/camera/depth/image_raw", ImageMessage(0, Depth(7), "16UC1"));
  Add(kColorCamera, Camera(50, "plumb_bob", 0.25));
  Add("/camera/depth/camera_info", Camera(40));
  const cv::Mat metre(48, 64, CV_16UC1, cv::Scalar(1000));
  Add("/camera/depth_registered/image_raw", ImageMessage(0, metre, "16UC1"));
  Add(kColorTopic, ImageMessage(0, Noise(CV_8UC3, 0), "rgb8"));
  Close();
  ImageFolderReader reader(Path());
  EXPECT_EQ(reader.camera().fx, 50);
  EXPECT_EQ(reader.camera().width, 64);
  EXPECT_EQ(reader.calibration().lens.coefficients[0], 0.25);
  EXPECT_FLOAT_EQ(reader.Next()->depth.at<float>(24, 32), 1);
}

TEST_F(RosBags, EncodingsBecomeTheSameColours) {
  const cv::Mat bgr = Noise(CV_8UC3, 0);
  const cv::Mat grey = Noise(CV_8UC1, 1);
  cv::Mat rgb;
  cv::Mat rgba;
  cv::Mat bgra;
  cv::Mat grey_bgr;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  cv::cvtColor(bgr, rgba, cv::COLOR_BGR2RGBA);
  cv::cvtColor(bgr, bgra, cv::COLOR_BGR2BGRA);
  cv::cvtColor(grey, grey_bgr, cv::COLOR_GRAY2BGR);
  struct Case {
    std::string encoding;
    cv::Mat written;
    cv::Mat expected;
  };
  const std::vector<Case> cases = {
      {"rgb8", rgb, bgr},
      {"bgr8", bgr, bgr},
      {"8UC3", bgr, bgr},
      {"rgba8", rgba, bgr},
      {"bgra8", bgra, bgr},
      {"mono8", grey, grey_bgr},
      {"8UC1", grey, grey_bgr},
      {"mono16", Depth(2), Depth(2)},
      {"32FC1", Noise(CV_32FC1, 3), Noise(CV_32FC1, 3)}};
  New();
  for (const Case& c : cases) {
    Add("/" + c.encoding, ImageMessage(0, c.written, c.encoding));
  }
  // Rows may be longer than their pixels.
  cv::Mat wide = cv::Mat::zeros(48, 70, CV_8UC3);
  bgr.copyTo(wide.colRange(0, 64));
  sensor_msgs::Image padded = ImageMessage(0, wide, "bgr8");
  padded.width = 64;
  Add("/padded", padded);
  Add("/png", CompressedMessage(0, bgr, ".png", "bgr8; png compressed bgr8"));
  Close();
  const std::unique_ptr<RosBag> bag = OpenRosBag(Path());
  for (const Case& c : cases) {
    SCOPED_TRACE(c.encoding);
    ExpectSame(bag->Image("/" + c.encoding, 0), c.expected);
  }
  ExpectSame(bag->Image("/padded", 0), bgr);
  ExpectSame(bag->Image("/png", 0), bgr);
}

TEST_F(RosBags, ImagesMayBeCompressedThemselves) {
  const std::string depth = "/camera/depth/image/compressedDepth";
  const std::string color = "/camera/color/image_raw/compressed";
  New(compression::LZ4);
  Add("/camera/depth/camera_info", Camera(50));
  const cv::Mat plain(48, 64, CV_8UC3, cv::Scalar(10, 20, 30));
  Add(color, CompressedMessage(0, plain, ".jpg", "rgb8; jpeg compressed bgr8"));
  Add(depth,
      CompressedMessage(0, Depth(0), ".png", "16UC1; compressedDepth png",
                        std::vector<std::uint8_t>(12, 1)));
  Close();
  ImageFolderReader reader(Path());
  EXPECT_NEAR(reader.Next()->color.at<cv::Vec3b>(24, 32)[2], 30, 3);
  ExpectSame(OpenRosBag(Path())->Image(depth, 0), Depth(0));
}

/// 32FC1 as compressed_depth_image_transport writes it by default: up to 10 m,
/// quantised as 100 says.
sensor_msgs::CompressedImage InverseDepth(const cv::Mat_<float>& metres,
                                          float a = 100 * 101) {
  const float b = 1 - a / 10;
  cv::Mat_<std::uint16_t> inverse(metres.size(), std::uint16_t{0});
  for (int v = 0; v < metres.rows; ++v) {
    for (int u = 0; u < metres.cols; ++u) {
      const float z = metres(v, u);
      if (z > 0) inverse(v, u) = static_cast<std::uint16_t>(a / z + b);
    }
  }
  std::vector<std::uint8_t> configuration(12);
  std::memcpy(configuration.data() + 4, &a, sizeof(a));
  std::memcpy(configuration.data() + 8, &b, sizeof(b));
  return CompressedMessage(0, inverse, ".png", "32FC1; compressedDepth png",
                           configuration);
}

TEST_F(RosBags, DepthInMetresMayBeQuantised) {
  const std::string topic = "/camera/depth/image/compressedDepth";
  const auto write = [&](const sensor_msgs::CompressedImage& depth) {
    New();
    Add("/camera/depth/camera_info", Camera(50));
    Add(kColorTopic, ImageMessage(0, Noise(CV_8UC3, 0), "rgb8"));
    Add(topic, depth);
    Close();
  };
  cv::Mat_<float> metres;
  Depth(0).convertTo(metres, CV_32FC1, 3 / 1000.0);
  metres(5, 7) = 0;
  write(InverseDepth(metres));
  const cv::Mat image = OpenRosBag(Path())->Image(topic, 0);
  ASSERT_EQ(image.type(), CV_32FC1);
  EXPECT_EQ(image.at<float>(5, 7), 0);
  // A step is z^2 / a: 1.1 mm at 3.4 m.
  EXPECT_LT(cv::norm(image, metres, cv::NORM_INF), 1.3e-3);
  EXPECT_NEAR(ImageFolderReader(Path()).Next()->depth.at<float>(24, 32),
              metres(24, 32), 1.3e-3);
  write(InverseDepth(metres, std::nanf("")));
  ExpectRefused("compressedDepth with nan and ");
  sensor_msgs::CompressedImage other = InverseDepth(metres);
  other.format = "32FC1; compressedDepth rvl";
  write(other);
  ExpectRefused("message 0: '32FC1; compressedDepth rvl': expected");
  other.format = "32FC1; compressedDepth";
  other.data.resize(8);
  write(other);
  ExpectRefused("message 0: 0 bytes that are no image");
}

TEST_F(RosBags, WhatIsNoneIsNamed) {
  const std::string none = " bytes that are no .bag of ROS 1, version 2.0, or";
  ExpectRefusedWith("", "take.bag: 0" + none);
  ExpectRefusedWith("#ROSBAG V1.2\n", "take.bag: 13" + none);
  ExpectRefusedWith("#ROS" + std::string(900, 'A') + " V2.0\n", none);
  cv::Mat garbage(1, 20000, CV_8UC1);
  cv::RNG(1).fill(garbage, cv::RNG::UNIFORM, 0, 256);
  const std::string bytes(garbage.begin<char>(), garbage.end<char>());
  ExpectRefusedWith(bytes, none);
  ExpectRefusedWith("#ROSBAG V2.0\n" + bytes, none);
  New();
  Close();
  ExpectRefused("take.bag: no images of depth and colour: expected topics");
}

TEST_F(RosBags, WrongTopicsAreNamed) {
  const auto write = [&](const std::string& depth, const std::string& color,
                         int time) {
    New();
    Add(depth, ImageMessage(0, Depth(0), "16UC1"));
    Add(color, ImageMessage(time, Noise(CV_8UC3, 0), "rgb8"));
    Add("/camera/rgb/camera_info", Camera(50));
    Close();
  };
  write("/camera/depth", "/camera/infra", 0);
  ExpectRefused("take.bag: no images of depth and colour: expected topics of");
  write("/camera/range", "/camera/rgb/image", 0);
  ExpectRefused("with 'depth', and with 'rgb' or 'color'");
  write("/camera/depth", "/camera/rgb/image", 5);
  ExpectRefused("take.bag: 0 frames: expected colour and depth within 0.02 s");
  New();
  Add("/camera/depth/camera_info", Camera(50));
  Add("/camera/rgb/camera_info", Camera(50));
  Close();
  ExpectRefused("take.bag: no images of depth and colour");
}

TEST_F(RosBags, TruncatedOnesAreNamed) {
  for (const auto how :
       {compression::Uncompressed, compression::BZ2, compression::LZ4}) {
    WriteTwoFrames(how);
    const std::string bytes = folder_.Read("take.bag");
    for (const double part : {0.0001, 0.01, 0.2, 0.5, 0.9, 0.99}) {
      const auto size = static_cast<std::size_t>(part * bytes.size());
      ExpectRefusedWith(bytes.substr(0, size), "or a truncated one");
    }
    ExpectRefusedWith(bytes.substr(0, bytes.size() - 1), "or a truncated one");
    const std::uint64_t no_index = 0;
    ExpectRefusedWith(With(bytes, After("index_pos=", bytes), no_index),
                      "take.bag: has no index, as if its recording was "
                      "interrupted: expected one, as after 'rosbag reindex'");
  }
}

TEST_F(RosBags, WrongLengthsAndOffsetsTakeNoMemory) {
  const std::string none = " bytes that are no .bag of ROS 1, version 2.0, or";
  const std::uint32_t huge = 0xf0000000;
  WriteTwoFrames(compression::Uncompressed);
  const std::string bytes = folder_.Read("take.bag");
  const std::size_t index_pos = After("index_pos=", bytes);
  const std::size_t chunk_pos = After("chunk_pos=", bytes);
  ExpectRefusedWith(With(bytes, After("V2.0\n", bytes), huge), none);
  ExpectRefusedWith(With(bytes, index_pos, std::uint64_t{huge}), none);
  ExpectRefusedWith(With(bytes, index_pos, std::uint64_t{100}), none);
  ExpectRefusedWith(With(bytes, chunk_pos, std::uint64_t{100}), none);
  // An index: how many messages; length of that; time and offset of the first.
  const std::size_t count = After("count=", bytes, bytes.find("op=\x04") - 30);
  const std::size_t entry = After("ver=", bytes, count) + 8;
  ExpectRefusedWith(With(bytes, count, huge), none);
  ExpectRefusedWith(With(bytes, entry + 8, huge), none);
  ExpectRefusedWith(With(bytes, entry + 8, std::uint32_t{100}), none);
  // After the encoding: byte order, length of a row, length of all.
  const std::size_t pixels = After("16UC1", bytes) + 5;
  ExpectRefusedWith(With(bytes, pixels, huge),
                    kDepthTopic + std::string(", message 0: is truncated"));
  for (const auto how : {compression::BZ2, compression::LZ4}) {
    WriteTwoFrames(how);
    const std::string compressed = folder_.Read("take.bag");
    const std::size_t size =
        After("size=", compressed, compressed.find("compression="));
    ExpectRefusedWith(With(compressed, size, huge), none);
  }
}

TEST_F(RosBags, NoDamageEndsInAnythingButALine) {
  cv::RNG random(3);
  for (const auto how :
       {compression::Uncompressed, compression::BZ2, compression::LZ4}) {
    WriteTwoFrames(how);
    const std::string bytes = folder_.Read("take.bag");
    int refused = 0;
    for (int i = 0; i < 100; ++i) {
      std::string damaged = bytes;
      // Half of them among the index at the end.
      const int size = static_cast<int>(bytes.size());
      const int from = i % 2 == 0 ? 4096 : size - 4000;
      for (int k = 0; k < 4; ++k) {
        damaged[random.uniform(from, size)] =
            static_cast<char>(random.uniform(0, 256));
      }
      folder_.Write("take.bag", damaged);
      try {
        ReadAll();
      } catch (const InputError& error) {
        ++refused;
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos)
            << error.what();
      }
    }
    EXPECT_GT(refused, 20);
  }
}

TEST_F(RosBags, BrokenMessagesAreNamed) {
  const auto write = [&](const sensor_msgs::Image& depth,
                         const sensor_msgs::CameraInfo& camera) {
    New();
    Add("/depth/image", depth);
    Add("/rgb/image", ImageMessage(0, Noise(CV_8UC3, 0), "rgb8"));
    Add("/depth/camera_info", camera);
    Close();
  };
  sensor_msgs::Image depth = ImageMessage(0, Depth(0), "16UC1");
  write(depth, Camera(50, "equidistant", 0.1));
  ExpectRefused("message 0: distortion 'equidistant' of 5 coefficients");
  sensor_msgs::CameraInfo wide = Camera(50);
  wide.width = 4000000000;
  write(depth, wide);
  ExpectRefused("message 0: 4000000000x48 pixels: expected 20000 at most");
  depth.data.pop_back();
  write(depth, Camera(50));
  ExpectRefused(
      "take.bag: /depth/image, message 0: image of 6143 bytes: expected 64x48");
  write(ImageMessage(0, Noise(CV_8UC1, 0), "bayer_rggb8"), Camera(50));
  ExpectRefused("message 0: encoding 'bayer_rggb8': expected rgb8, bgr8");
  write(ImageMessage(0, Noise(CV_8UC3, 0), "rgb8"), Camera(50));
  ExpectRefused("an image of another kind: expected colour of 8 bit");
}

}  // namespace
}  // namespace splitfusion

#endif  // SPLITFUSION_WITH_ROSBAG
