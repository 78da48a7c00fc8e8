#include "splitfusion/lib/sequence/image_header.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "splitfusion/lib/sequence/image_file.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

class ImageHeaderTest : public ::testing::Test {
 protected:
  /// Noise of 32x24 pixels, so that the file is not all header.
  std::string Write(const std::string& name, int type) const {
    cv::Mat image(24, 32, type);
    cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 255);
    cv::imwrite(folder_ / name, image);
    return folder_ / name;
  }
  void Refuses(const std::string& path, const std::string& part) const {
    ExpectInputError([&] { ReadImageHeader(path); }, path + ": " + part);
    ExpectInputError([&] { ReadColorImage(path); }, path + ": " + part);
  }
  /// Expects the header to be what the decoder finds.
  void AgreesWithTheDecoder(const std::string& name, int type) const {
    const std::string path = Write(name, type);
    const auto header = ReadImageHeader(path);
    const cv::Mat image = cv::imread(path, cv::IMREAD_UNCHANGED);
    ASSERT_TRUE(header) << name;
    EXPECT_EQ(header->size, image.size()) << name;
    EXPECT_EQ(header->bits, 8 * static_cast<int>(image.elemSize1())) << name;
    EXPECT_EQ(header->channels, image.channels()) << name;
  }

  TemporaryFolder folder_;
};

TEST_F(ImageHeaderTest, SaysWhatTheDecoderFinds) {
  AgreesWithTheDecoder("grey16.png", CV_16UC1);
  AgreesWithTheDecoder("grey8.png", CV_8UC1);
  AgreesWithTheDecoder("color8.png", CV_8UC3);
  AgreesWithTheDecoder("color16.png", CV_16UC3);
  AgreesWithTheDecoder("alpha.png", CV_8UC4);
  AgreesWithTheDecoder("color.jpg", CV_8UC3);
  AgreesWithTheDecoder("grey.jpg", CV_8UC1);
}

TEST_F(ImageHeaderTest, OtherFormatsAreLeftToTheDecoder) {
  EXPECT_FALSE(ReadImageHeader(Write("color.bmp", CV_8UC3)));
  EXPECT_EQ(ReadColorImage(folder_ / "color.bmp").size(), cv::Size(32, 24));
}

TEST_F(ImageHeaderTest, WhatIsNoFileIsNotOpened) {
  ASSERT_EQ(mkfifo((folder_ / "pipe.png").c_str(), 0600), 0);
  Refuses(folder_ / "pipe.png", "is no regular file");
  Refuses("/dev/zero", "is no regular file");
  fs::create_directories(folder_ / "folder.png");
  Refuses(folder_ / "folder.png", "is no regular file");
  Refuses(folder_ / "none.png", "cannot be opened");
}

TEST_F(ImageHeaderTest, LinksToFilesAreFine) {
  fs::create_symlink(Write("a.png", CV_8UC3), folder_ / "b.png");
  EXPECT_TRUE(ReadImageHeader(folder_ / "b.png"));
}

TEST_F(ImageHeaderTest, TruncatedFilesAreNoticedWhereverTheyEnd) {
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::string path = Write(name, CV_8UC3);
    const std::uintmax_t size = fs::file_size(path);
    for (std::uintmax_t left = size - 5; left < size; left -= 7) {
      fs::resize_file(path, left);
      ExpectInputError([&] { ReadImageHeader(path); },
                       std::to_string(left) + " bytes that are no image or a");
    }
  }
}

TEST_F(ImageHeaderTest, BytesAfterTheImageAreFine) {
  for (const char* name : {"a.png", "a.jpg"}) {
    std::string bytes = (Write(name, CV_8UC3), folder_.Read(name));
    folder_.Write(name, bytes + std::string(5000, '\0'));
    EXPECT_TRUE(ReadImageHeader(folder_ / name)) << name;
  }
}

/// A segment of application data, as cameras write it.
std::string Segment(const std::string& data) {
  const std::size_t size = data.size() + 2;
  return {std::string("\xff\xe1") + static_cast<char>(size / 256) +
          static_cast<char>(size % 256) + data};
}

TEST_F(ImageHeaderTest, AThumbnailDoesNotEndAJpeg) {
  Write("a.jpg", CV_8UC3);
  std::string bytes = folder_.Read("a.jpg");
  bytes.insert(2, Segment("a thumbnail \xff\xd8 that ends \xff\xd9 here"));
  folder_.Write("a.jpg", bytes);
  EXPECT_TRUE(ReadImageHeader(folder_ / "a.jpg"));
  folder_.Write("a.jpg", bytes.substr(0, bytes.size() * 3 / 4));
  Refuses(folder_ / "a.jpg", std::to_string(bytes.size() * 3 / 4) + " bytes");
}

TEST_F(ImageHeaderTest, OrientationsAreIgnored) {
  Write("a.jpg", CV_8UC3);
  std::string bytes = folder_.Read("a.jpg");
  // Exif: one entry, orientation (0x112) = 6, a turn by 90 degrees.
  bytes.insert(2, Segment(std::string("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0"
                                      "\x03\0\0\0\x01\0\x06\0\0\0\0\0\0",
                                      32)));
  folder_.Write("a.jpg", bytes);
  ASSERT_EQ(cv::imread(folder_ / "a.jpg").size(), cv::Size(24, 32));
  EXPECT_EQ(ReadColorImage(folder_ / "a.jpg").size(), cv::Size(32, 24));
  EXPECT_EQ(ReadImageHeader(folder_ / "a.jpg")->size, cv::Size(32, 24));
}

TEST_F(ImageHeaderTest, AbsurdSizesAreNotDecoded) {
  Write("a.png", CV_8UC1);
  std::string bytes = folder_.Read("a.png");
  bytes.replace(16, 8, std::string("\0\0\x75\x30\0\0\x75\x30", 8));
  folder_.Write("a.png", bytes);
  Refuses(folder_ / "a.png", "image of 30000x30000: expected at most 100 mil");
  bytes.replace(16, 8, std::string("\xff\xff\xff\xff\xff\xff\xff\xff", 8));
  folder_.Write("a.png", bytes);
  Refuses(folder_ / "a.png", "image of 4294967295x4294967295: expected at mo");
  bytes.replace(16, 4, std::string(4, '\0'));
  folder_.Write("a.png", bytes);
  Refuses(folder_ / "a.png", std::to_string(bytes.size()) + " bytes that are");
}

TEST_F(ImageHeaderTest, GarbageIsNoImage) {
  Refuses(folder_.Write("a.png", "an essay that is long enough to be one"),
          "38 bytes that are no image");
  Refuses(folder_.Write("a.jpg", "\xff\xd8" + std::string(100000, '\xff')),
          "100002 bytes that are no image");
  Refuses(folder_.Write("a.bmp", ""), "0 bytes");
}

}  // namespace
}  // namespace splitfusion
