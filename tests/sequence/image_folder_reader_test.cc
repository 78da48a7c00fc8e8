#include "splitfusion/lib/sequence/image_folder_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "support/expect_input_error.h"
#include "support/shared_data.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Three frames of 32x24 pixels; depth 1, 2 and 3 m.
class ImageFolderReaderTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string list;
    for (int i = 0; i < 3; ++i) {
      const std::string n = std::to_string(i);
      folder_.Write("rgb/c" + n + ".png", "");
      folder_.Write("depth/d" + n + ".png", "");
      cv::imwrite(folder_ / ("rgb/c" + n + ".png"),
                  cv::Mat(24, 32, CV_8UC3, cv::Scalar(10, 20, 30 + i)));
      WriteDepth(i, cv::Mat(24, 32, CV_16UC1, cv::Scalar(1000 * (i + 1))));
      list += n + ".0 rgb/c" + n + ".png " + n + ".5 depth/d" + n + ".png\n";
    }
    folder_.Write("associations.txt", list);
    folder_.Write("calibration.txt", "30 31 16 12 32 24 1000\n");
  }

  void WriteDepth(int i, const cv::Mat& depth) {
    cv::imwrite(DepthPath(i), depth);
  }
  std::string DepthPath(int i) const {
    return folder_ / ("depth/d" + std::to_string(i) + ".png");
  }
  /// Expects that the first frame is refused.
  void ExpectRefused(const std::string& part) {
    ImageFolderReader reader(folder_ / "");
    ExpectInputError([&] { reader.Next(); }, part);
  }

  TemporaryFolder folder_;
};

TEST_F(ImageFolderReaderTest, GivesFramesInOrder) {
  ImageFolderReader reader(folder_ / "");
  EXPECT_EQ(reader.size(), 3);
  EXPECT_EQ(reader.camera().width, 32);
  EXPECT_DOUBLE_EQ(reader.camera().fy, 31);
  for (int i = 0; i < 3; ++i) {
    const std::optional<Frame> frame = reader.Next();
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->index, i);
    EXPECT_DOUBLE_EQ(frame->timestamp, i + 0.5);
    EXPECT_EQ(frame->stem, "d" + std::to_string(i));
    EXPECT_FLOAT_EQ(frame->depth.at<float>(5, 7), i + 1.0f);
    EXPECT_EQ(frame->color.at<cv::Vec3b>(5, 7), cv::Vec3b(10, 20, 30 + i));
  }
  EXPECT_FALSE(reader.Next().has_value());
}

TEST_F(ImageFolderReaderTest, TimeStampsThatDoNotAscendAreNoted) {
  EXPECT_EQ(ImageFolderReader(folder_ / "").TimesNote(), "");
  folder_.Write("associations.txt",
                "0 rgb/c0.png 0.5 depth/d0.png\n"
                "1 rgb/c1.png 1.5 depth/d1.png\n"
                "2 rgb/c2.png 1.5 depth/d2.png\n");
  EXPECT_THAT(ImageFolderReader(folder_ / "").TimesNote(),
              testing::HasSubstr("frame 2 has time stamp 1.5"));
}

TEST_F(ImageFolderReaderTest, ReadsAPartUnderItsOwnIndices) {
  ReaderOptions options;
  options.first_frame = 1;
  options.max_frames = 1;
  ImageFolderReader reader(folder_ / "", options);
  EXPECT_EQ(reader.size(), 1);
  EXPECT_EQ(reader.Next()->index, 1);
  EXPECT_FALSE(reader.Next().has_value());
}

TEST_F(ImageFolderReaderTest, ReadsEverySoManyFramesUnderTheirOwnIndices) {
  ReaderOptions options;
  options.frame_step = 2;
  ImageFolderReader reader(folder_ / "", options);
  ASSERT_EQ(reader.size(), 2);
  EXPECT_EQ(reader.Next()->index, 0);
  const Frame last = *reader.Next();
  EXPECT_EQ(last.index, 2);
  EXPECT_EQ(last.stem, "d2");
  EXPECT_FALSE(reader.Next().has_value());
  options.first_frame = 1;
  EXPECT_EQ(ImageFolderReader(folder_ / "", options).size(), 1);
  options.first_frame = 0;
  options.max_frames = 1;
  EXPECT_EQ(ImageFolderReader(folder_ / "", options).size(), 1);
  options.frame_step = 0;
  ExpectInputError([&] { ImageFolderReader reader(folder_ / "", options); },
                   "frame_step = 0: expected a number >= 1");
}

TEST_F(ImageFolderReaderTest, GivesImagesWithoutTheDistortionOfTheirLens) {
  std::filesystem::remove(folder_ / "calibration.txt");
  const std::string keys =
      "width 32\nheight 24\nfx 30\nfy 30\ncx 16\ncy 12\n"
      "depth_scale 1000\n";
  folder_.Write("camera.txt", keys + "k1 0.5\n");
  cv::Mat depth(24, 32, CV_16UC1, cv::Scalar(1000));
  depth.colRange(0, 8).setTo(2000);
  WriteDepth(0, depth);
  cv::Mat color(24, 32, CV_8UC3, cv::Scalar(10, 20, 30));
  color.colRange(0, 8).setTo(cv::Scalar(90, 20, 30));
  cv::imwrite(folder_ / "rgb/c0.png", color);
  const ImageFolderReader reader(folder_ / "");
  const Frame frame = reader.Read(0);
  // Pixel 8 of the row of the middle is at 7.72 in the file, that of a row
  // farther up at 7.36.
  EXPECT_EQ(frame.color.at<cv::Vec3b>(12, 10)[0], 10);
  EXPECT_EQ(frame.color.at<cv::Vec3b>(12, 6)[0], 90);
  EXPECT_FLOAT_EQ(reader.ReadDepth(0)(3, 8), 2);
  EXPECT_FLOAT_EQ(reader.ReadDepth(0)(12, 8), 1);
  ASSERT_TRUE(reader.color_undistortion());
  // Intrinsics from elsewhere leave the lens.
  ReaderOptions options;
  options.camera = PinholeCamera{32, 24, 30, 30, 16, 12};
  options.depth_scale = 1000;
  EXPECT_TRUE(ImageFolderReader(folder_ / "", options).color_undistortion());
}

TEST_F(ImageFolderReaderTest, ColourMayHaveAnotherSize) {
  cv::imwrite(folder_ / "rgb/c0.png",
              cv::Mat(48, 64, CV_8UC3, cv::Scalar(10, 20, 30)));
  folder_.Write("color_camera.txt", "60 60 32 24 0 0 0 0 0 0 1 64 48\n");
  ImageFolderReader reader(folder_ / "");
  EXPECT_EQ(reader.color_size(), cv::Size(64, 48));
  EXPECT_EQ(reader.Next()->color.size(), cv::Size(64, 48));
  ExpectInputError([&] { reader.CheckFrames(); },
                   "c1.png: image of 32x24: expected 64x48");
}

TEST_F(ImageFolderReaderTest, OptionsReplaceTheCalibrationFile) {
  ReaderOptions options;
  options.depth_scale = 500;
  options.depth.noise.growth = 0.001;
  EXPECT_FLOAT_EQ(
      ImageFolderReader(folder_ / "", options).Next()->depth.at<float>(0),
      2.0f);
  options.camera = PinholeCamera{32, 24, 40, 40, 15, 11};
  std::filesystem::remove(folder_ / "calibration.txt");
  EXPECT_DOUBLE_EQ(ImageFolderReader(folder_ / "", options).camera().fx, 40);
  EXPECT_EQ(ImageFolderReader(folder_ / "", options).camera().noise.growth,
            0.001);
  ExpectInputError([&] { ImageFolderReader reader(folder_ / ""); },
                   "neither calibration.txt nor camera.txt");
}

TEST_F(ImageFolderReaderTest, NamesMissingAndBrokenImages) {
  std::filesystem::resize_file(DepthPath(0), 60);
  ExpectRefused("d0.png: 60 bytes that are no image or a truncated one");
  std::filesystem::resize_file(DepthPath(0), 0);
  ExpectRefused("d0.png: 0 bytes");
  std::filesystem::remove(DepthPath(0));
  ExpectRefused("d0.png: cannot be opened");
}

TEST_F(ImageFolderReaderTest, NamesWrongSizesAndTypes) {
  WriteDepth(0, cv::Mat(12, 16, CV_16UC1, cv::Scalar(1000)));
  ExpectRefused("d0.png: image of 16x12: expected 32x24");
  WriteDepth(0, cv::Mat(24, 32, CV_8UC1, cv::Scalar(100)));
  ExpectRefused("d0.png: image of 8 bit, 1 channel(s): expected a depth image");
  cv::imwrite(folder_ / "rgb/c0.png", cv::Mat(30, 32, CV_8UC3));
  ExpectRefused("c0.png: image of 32x30");
}

TEST_F(ImageFolderReaderTest, RefusesTruncatedJpeg) {
  const std::string path = folder_ / "rgb/c0.jpg";
  cv::Mat noise(24, 32, CV_8UC3);
  cv::RNG(1).fill(noise, cv::RNG::UNIFORM, 0, 255);
  cv::imwrite(path, noise);
  folder_.Write("associations.txt", "0 rgb/c0.jpg 0 depth/d0.png\n");
  EXPECT_TRUE(ImageFolderReader(folder_ / "").Next().has_value());
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  ExpectRefused("c0.jpg");
}

TEST_F(ImageFolderReaderTest, AllFramesAreLookedAtBeforeTheFirst) {
  EXPECT_TRUE(ImageFolderReader(folder_ / "").FindBadFrames().empty());
  EXPECT_NO_THROW(ImageFolderReader(folder_ / "").CheckFrames());
  std::filesystem::remove(folder_ / "rgb/c1.png");
  WriteDepth(2, cv::Mat(24, 32, CV_8UC1, cv::Scalar(100)));
  const ImageFolderReader reader(folder_ / "");
  const std::vector<BadFrame> bad = reader.FindBadFrames();
  ASSERT_EQ(bad.size(), 2u);
  EXPECT_EQ(bad[0].index, 1);
  EXPECT_EQ(bad[0].stem, "d1");
  EXPECT_NE(bad[0].reason.find("c1.png: cannot be opened"), std::string::npos);
  EXPECT_EQ(bad[1].index, 2);
  EXPECT_NE(bad[1].reason.find("d2.png: image of 8 bit"), std::string::npos);
  ExpectInputError([&] { reader.CheckFrames(); },
                   "(no such file) (and 1 more bad frames)");
  ReaderOptions options;
  options.max_frames = 1;
  EXPECT_NO_THROW(ImageFolderReader(folder_ / "", options).CheckFrames())
      << "frames that are not read";
}

TEST_F(ImageFolderReaderTest, BadFramesAreLeftOutIfAskedFor) {
  std::filesystem::resize_file(DepthPath(1), 60);
  ReaderOptions options;
  options.skip_bad_frames = true;
  ImageFolderReader reader(folder_ / "", options);
  EXPECT_EQ(reader.size(), 2);
  EXPECT_EQ(reader.Stem(1), "d2");
  EXPECT_NO_THROW(reader.CheckFrames());
  EXPECT_EQ(reader.Next()->index, 0);
  const std::optional<Frame> frame = reader.Next();
  EXPECT_EQ(frame->index, 2) << "indices stay";
  EXPECT_EQ(frame->stem, "d2");
  EXPECT_FALSE(reader.Next().has_value());
  ASSERT_EQ(reader.skipped().size(), 1u);
  EXPECT_EQ(reader.skipped()[0].stem, "d1");
}

/// Makes a file that only the decoder can find out about.
void Damage(const std::string& path) {
  std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(41);  // Within the compressed pixels.
  stream << "XXXXXXXX";
}

TEST_F(ImageFolderReaderTest, FramesThatCannotBeDecodedAreLeftOutIfAskedFor) {
  Damage(DepthPath(0));
  ReaderOptions options;
  options.skip_bad_frames = true;
  ImageFolderReader reader(folder_ / "", options);
  EXPECT_EQ(reader.size(), 3);
  EXPECT_EQ(reader.Next()->index, 1);
  EXPECT_EQ(reader.size(), 2);
  ASSERT_EQ(reader.skipped().size(), 1u);
  EXPECT_EQ(reader.skipped()[0].index, 0);
  EXPECT_NE(reader.skipped()[0].reason.find("d0.png"), std::string::npos);
  EXPECT_EQ(reader.Next()->index, 2);
  EXPECT_FALSE(reader.Next().has_value());
  // Going on counts the frames that could be read.
  ImageFolderReader resumed(folder_ / "", options);
  resumed.SkipTo(1);
  EXPECT_EQ(resumed.Next()->index, 2);
  EXPECT_FALSE(resumed.Next().has_value());
  EXPECT_EQ(resumed.size(), 2);
}

TEST_F(ImageFolderReaderTest, NoFrameAtAllIsAnError) {
  for (int i = 0; i < 3; ++i) std::filesystem::remove(DepthPath(i));
  ReaderOptions options;
  options.skip_bad_frames = true;
  ExpectInputError([&] { ImageFolderReader reader(folder_ / "", options); },
                   "d0.png: cannot be opened (no such file) (and none of the "
                   "other 2 frames can be read)");
}

TEST_F(ImageFolderReaderTest, NamesBadOptions) {
  ReaderOptions options;
  options.first_frame = 3;
  ExpectInputError([&] { ImageFolderReader reader(folder_ / "", options); },
                   "first_frame = 3: expected less than the 3 frames");
  options = {};
  options.max_frames = -1;
  ExpectInputError([&] { ImageFolderReader reader(folder_ / "", options); },
                   "max_frames = -1");
}

TEST(ImageFolderReader, ReadsSharedSequences) {
  for (const char* name : {"walking_xyz", "snoopy", "tum_fr1_rpy"}) {
    const std::string path = SharedData(name);
    SKIP_WITHOUT_SHARED_DATA(path, name);
    ImageFolderReader reader(path);
    EXPECT_GE(reader.size(), 60);
    const std::optional<Frame> frame = reader.Next();
    EXPECT_EQ(frame->depth.size(), cv::Size(640, 480));
    EXPECT_GT(cv::countNonZero(frame->depth), 640 * 480 / 2) << name;
    double largest = 0;
    cv::minMaxLoc(frame->depth, nullptr, &largest);
    EXPECT_LE(largest, 5.0);
    EXPECT_GT(largest, 1.0);
  }
}

TEST_F(ImageFolderReaderTest, GivenPosesAreThoseOfTheNearestTime) {
  const std::string path = folder_.Write(
      "given.txt",
      "0.49 1 2 3 0 0 0 1\n1.5 4 5 6 0 0 0 1\n1.515 9 9 9 0 0 0 1"
      "\n2.51 7 8 9 0 0.70710678118654752 0 0.70710678118654752\n");
  ReaderOptions options;
  options.trajectory = path;
  ImageFolderReader reader(folder_ / "", options);
  for (int i = 0; i < 3; ++i) {
    const Frame frame = *reader.Next();
    ASSERT_TRUE(frame.world_from_camera) << i;
    EXPECT_TRUE(frame.world_from_camera->translation().isApprox(
        Eigen::Vector3d(3 * i + 1, 3 * i + 2, 3 * i + 3), 1e-12))
        << i;
  }
  EXPECT_FALSE(ImageFolderReader(folder_ / "").Next()->world_from_camera);
}

TEST_F(ImageFolderReaderTest, GivenPosesAreOfOnePlace) {
  ReaderOptions options;
  options.trajectory = folder_.Write(
      "given.txt",
      "0.5 1 0 0 0 0 0 1\n1.5 30000 0 0 0 0 0 1\n2.5 1 0 0 0 0 0 1\n");
  ExpectInputError([&] { ImageFolderReader(folder_ / "", options); },
                   "given.txt: the pose at 1.500000 s is 29999.000000 m from "
                   "that of the first frame: expected 200 m at most");
}

TEST_F(ImageFolderReaderTest, EveryFrameNeedsAGivenPose) {
  ReaderOptions options;
  options.trajectory =
      folder_.Write("given.txt", "0.5 0 0 0 0 0 0 1\n1.53 0 0 0 0 0 0 1\n");
  ExpectInputError([&] { ImageFolderReader(folder_ / "", options); },
                   "given.txt: no pose within 0.02 s of 1.500000 s, frame 1");
  options.max_frames = 1;
  EXPECT_NO_THROW(ImageFolderReader(folder_ / "", options));
}

}  // namespace
}  // namespace splitfusion
