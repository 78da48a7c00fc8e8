// A small sample of every data set's layout, made here, and what is read of it.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class DataSets : public ::testing::Test {
 protected:
  /// Colour whose blue is `blue`.
  void WriteColor(const std::string& name, int blue, int width = 64,
                  int height = 48) {
    folder_.Write(name, "");
    cv::imwrite(folder_ / name,
                cv::Mat(height, width, CV_8UC3, cv::Scalar(blue, 20, 30)));
  }
  /// Depth that is the same everywhere.
  void WriteDepth(const std::string& name, int value, int width = 64,
                  int height = 48) {
    folder_.Write(name, "");
    cv::imwrite(folder_ / name,
                cv::Mat(height, width, CV_16UC1, cv::Scalar(value)));
  }
  /// Reads a sequence of two frames, 1 and 2 m away, with blue of 10 and 20;
  /// `format`: as which it is recognised.
  void ExpectTwoFrames(const std::string& sequence, const std::string& format) {
    ImageFolderReader reader(folder_ / sequence);
    EXPECT_EQ(reader.options().format, format);
    EXPECT_NO_THROW(reader.CheckFrames());
    ASSERT_EQ(reader.size(), 2);
    for (int i = 0; i < 2; ++i) {
      const Frame frame = *reader.Next();
      EXPECT_EQ(frame.index, i);
      EXPECT_NEAR(frame.color.at<cv::Vec3b>(20, 30)[0], 10 * (i + 1), 3);
      EXPECT_FLOAT_EQ(frame.depth.at<float>(20, 30), i + 1.0f);
      EXPECT_EQ(frame.color.size(), reader.color_size());
    }
    EXPECT_FALSE(reader.Next());
  }
  void ExpectRefused(const std::string& sequence, const std::string& format,
                     const std::string& message) {
    ReaderOptions options;
    options.format = format;
    ExpectInputError(
        [&] {
          ImageFolderReader reader(folder_ / sequence, options);
          while (reader.Next()) {
          }
        },
        message);
  }

  TemporaryFolder folder_;
};

constexpr char kMatrix[] = "50 0 31.5 0\n0 51 23.5 0\n0 0 1 0\n0 0 0 1\n";
constexpr char kPoseAtTwo[] = "1 0 0 2\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

class BonnData : public DataSets {
 protected:
  void SetUp() override {
    std::string rgb, depth;
    for (int i = 0; i < 2; ++i) {
      const std::string n = std::to_string(i);
      WriteColor("rgbd_bonn_box/rgb/" + n + ".0.png", 10 * (i + 1), 640, 480);
      WriteDepth("rgbd_bonn_box/depth/" + n + ".01.png", 5000 * (i + 1), 640,
                 480);
      rgb += n + ".0 rgb/" + n + ".0.png\n";
      depth += n + ".01 depth/" + n + ".01.png\n";
    }
    folder_.Write("rgbd_bonn_box/rgb.txt", rgb);
    folder_.Write("rgbd_bonn_box/depth.txt", depth);
  }
};

TEST_F(BonnData, HasTheIntrinsicsAndTheLensOfItsAuthors) {
  ExpectTwoFrames("rgbd_bonn_box", "bonn");
  const ImageFolderReader reader(folder_ / "rgbd_bonn_box/");
  EXPECT_EQ(reader.options().format, "bonn");
  EXPECT_DOUBLE_EQ(reader.camera().fx, 542.822841);
  EXPECT_DOUBLE_EQ(reader.calibration().lens.coefficients[1], -0.099343);
  ASSERT_TRUE(reader.color_undistortion());
}

TEST_F(BonnData, AFileReplacesThem) {
  folder_.Write("rgbd_bonn_box/calibration.txt",
                "500 501 320 240 640 480 5000\n");
  const ImageFolderReader reader(folder_ / "rgbd_bonn_box");
  EXPECT_DOUBLE_EQ(reader.camera().fx, 500);
  EXPECT_FALSE(reader.color_undistortion());
}

TEST_F(BonnData, OfAnotherFolderIsTumAndNeedsACalibration) {
  std::filesystem::rename(folder_ / "rgbd_bonn_box", folder_ / "box");
  ExpectRefused("box", "auto", "neither calibration.txt nor camera.txt");
  ExpectRefused("none", "bonn", "no such folder");
}

TEST_F(BonnData, OfTumsNameHasTheCameraOfTheBenchmark) {
  const std::string name = "rgbd_dataset_freiburg2_box";
  std::filesystem::rename(folder_ / "rgbd_bonn_box", folder_ / name);
  ExpectTwoFrames(name, "tum");
  const ImageFolderReader reader(folder_ / name);
  EXPECT_DOUBLE_EQ(reader.camera().cy, 249.7);
  EXPECT_DOUBLE_EQ(reader.calibration().lens.coefficients[4], 0.9172);
}

class IclNuimData : public DataSets {
 protected:
  void SetUp() override {
    std::string list;
    for (int i = 0; i < 2; ++i) {
      const std::string n = std::to_string(i);
      WriteColor("traj0_frei_png/rgb/" + n + ".png", 10 * (i + 1), 640, 480);
      WriteDepth("traj0_frei_png/depth/" + n + ".png", 5000 * (i + 1), 640,
                 480);
      list += n + " depth/" + n + ".png " + n + " rgb/" + n + ".png\n";
    }
    folder_.Write("traj0_frei_png/associations.txt", list);
    // Turned about x by 90 degrees.
    folder_.Write("traj0_frei_png/livingRoom0.gt.freiburg",
                  "1 1 2 3 0.70710678118 0 0 0.70710678118\n");
  }
};

TEST_F(IclNuimData, HasPosesMirroredAndThirtyFramesASecond) {
  ExpectTwoFrames("traj0_frei_png", "icl_nuim");
  const ImageFolderReader reader(folder_ / "traj0_frei_png");
  EXPECT_DOUBLE_EQ(reader.camera().fy, 480);
  EXPECT_DOUBLE_EQ(reader.pairs()[1].depth.timestamp, 1 / 30.0);
  const Trajectory poses = reader.FindSequencePoses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_DOUBLE_EQ(poses[0].timestamp, 1 / 30.0);
  // What is ahead of the camera, (0, 0, 1), is turned to -y by the file, whose
  // y axis points up, and so to +y here, and the place is mirrored as well.
  EXPECT_TRUE((poses[0].world_from_camera * Eigen::Vector3d(0, 0, 1))
                  .isApprox(Eigen::Vector3d(1, -2 + 1, 3), 1e-9));
}

TEST_F(IclNuimData, BrokenPosesAreNamed) {
  const ImageFolderReader reader(folder_ / "traj0_frei_png");
  folder_.Write("traj0_frei_png/livingRoom0.gt.freiburg", "# none\n");
  ExpectInputError([&] { reader.FindSequencePoses(); },
                   "livingRoom0.gt.freiburg: 0 poses: expected lines");
  folder_.Write("traj0_frei_png/livingRoom0.gt.freiburg", "1 2 3\n");
  ExpectInputError([&] { reader.FindSequencePoses(); },
                   "livingRoom0.gt.freiburg:1");
}

TEST_F(DataSets, VolumeDeformHasDepthIntrinsicsBesideItsFrames) {
  for (int i = 0; i < 2; ++i) {
    const std::string stem = "boxing/data/frame-00000" + std::to_string(i);
    WriteColor(stem + ".color.png", 10 * (i + 1));
    WriteDepth(stem + ".depth.png", 1000 * (i + 1));
  }
  ExpectRefused("boxing/data", "volumedeform",
                "depthIntrinsics.txt: cannot be opened");
  folder_.Write("boxing/data/depthIntrinsics.txt", kMatrix);
  folder_.Write("boxing/data/colorIntrinsics.txt", kMatrix);
  ExpectTwoFrames("boxing", "volumedeform");
  ExpectTwoFrames("boxing/data", "volumedeform");
  const ImageFolderReader reader(folder_ / "boxing");
  EXPECT_EQ(reader.camera().width, 64) << "of the images";
  EXPECT_EQ(reader.camera().fy, 51);
  folder_.Write("boxing/data/depthIntrinsics.txt", "50 0 31.5\n");
  ExpectRefused("boxing", "auto", "depthIntrinsics.txt: a matrix of 1x3");
}

TEST_F(DataSets, SevenScenesHasPoses) {
  for (int i = 0; i < 2; ++i) {
    const std::string stem = "seq-01/frame-00000" + std::to_string(i);
    WriteColor(stem + ".color.png", 10 * (i + 1));
    WriteDepth(stem + ".depth.png", 1000 * (i + 1));
  }
  folder_.Write("seq-01/intrinsics.txt", kMatrix);
  folder_.Write("seq-01/frame-000001.pose.txt", kPoseAtTwo);
  ExpectTwoFrames("seq-01", "7scenes");
  const Trajectory poses =
      ImageFolderReader(folder_ / "seq-01").FindSequencePoses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].world_from_camera.translation().x(), 2);
  std::filesystem::remove(folder_ / "seq-01/frame-000001.color.png");
  ExpectRefused("seq-01", "auto", "frame-000001.color.png: cannot be opened");
  folder_.Write("seq-01/frame-000001.pose.txt", "1 0 0 0\n");
  ExpectInputError(
      [&] { ImageFolderReader(folder_ / "seq-01").FindSequencePoses(); },
      "frame-000001.pose.txt: a matrix of 1x4: expected 4x4");
}

constexpr char kInfo[] =
    "m_versionNumber = 4\nm_sensorName = StructureSensor\n"
    "m_colorWidth = 128\nm_colorHeight = 96\n"
    "m_depthWidth = 64\nm_depthHeight = 48\nm_depthShift = 1000\n"
    "m_calibrationColorIntrinsic = 100 0 64 0 0 100 48 0 0 0 1 0 0 0 0 1 \n"
    "m_calibrationColorExtrinsic = 1 0 0 -0.02 0 1 0 0 0 0 1 0 0 0 0 1 \n"
    "m_calibrationDepthIntrinsic = 50 0 31.5 0 0 51 23.5 0 0 0 1 0 0 0 0 1 \n"
    "m_calibrationDepthExtrinsic = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 \n";

class BundleFusionData : public DataSets {
 protected:
  void SetUp() override {
    for (int i = 0; i < 2; ++i) {
      const std::string stem = "apt0/frame-00000" + std::to_string(i);
      WriteColor(stem + ".color.jpg", 10 * (i + 1), 128, 96);
      WriteDepth(stem + ".depth.png", 1000 * (i + 1));
      folder_.Write(stem + ".pose.txt", i == 1 ? kPoseAtTwo
                                               : "-inf -inf -inf -inf\n"
                                                 "-inf -inf -inf -inf\n"
                                                 "-inf -inf -inf -inf\n"
                                                 "-inf -inf -inf -inf\n");
    }
    folder_.Write("apt0/info.txt", kInfo);
  }
};

TEST_F(BundleFusionData, HasBothCamerasInItsInfo) {
  ExpectTwoFrames("apt0", "bundlefusion");
  const ImageFolderReader reader(folder_ / "apt0");
  EXPECT_EQ(reader.camera().fx, 50);
  ASSERT_TRUE(reader.calibration().color);
  const ColorCamera& color = *reader.calibration().color;
  EXPECT_EQ(color.fx, 100);
  EXPECT_EQ(color.width, 128);
  EXPECT_DOUBLE_EQ(color.color_from_depth.translation().x(), 0.02);
  ASSERT_EQ(reader.FindSequencePoses().size(), 1u) << "the other is unknown";
}

TEST_F(BundleFusionData, ABrokenInfoIsNamed) {
  const auto change = [&](const std::string& from, const std::string& to) {
    std::string text = kInfo;
    text.replace(text.find(from), from.size(), to);
    folder_.Write("apt0/info.txt", text);
  };
  change("m_depthWidth = 64", "m_depthWidth = none");
  ExpectRefused("apt0", "auto", "info.txt:5: 'none': expected numbers");
  change("m_depthWidth = 64", "m_depthWidth = -1");
  ExpectRefused("apt0", "auto", "info.txt:5: '-1': expected a size in pixels");
  change("m_depthWidth = 64", "");
  ExpectRefused("apt0", "auto", "info.txt: no line 'm_depthWidth = ...'");
  change("50 0 31.5 0 0 51", "50 0 31.5 0 51");
  ExpectRefused("apt0", "auto", "expected a matrix of 4x4");
  change("m_depthWidth = 64", "m_depthWidth = 6.5");
  ExpectRefused("apt0", "auto", "info.txt:5: '6.5': expected a size in pixels");
  change("m_depthShift = 1000", "m_depthShift = 0");
  ExpectRefused("apt0", "auto", "info.txt:7: '0': expected depth units in a");
  change("Intrinsic = 100 0", "Intrinsic = -1 0");
  ExpectRefused("apt0", "auto",
                "info.txt: m_calibrationColorIntrinsic: '-1 0 64, 0 100 48, "
                "0 0 1': expected a matrix of intrinsics");
  change("Intrinsic = 50 0", "Intrinsic = 1e40 0");
  ExpectRefused("apt0", "auto",
                "apt0: camera fx = 1e+40: expected a focal length > 0, 100000");
  change("m_colorWidth = 128", "m_colorWidth = 64");
  ExpectRefused("apt0", "auto", "image of 128x96: expected 64x96");
}

class ScanNetData : public DataSets {
 protected:
  void SetUp() override {
    for (int i = 0; i < 2; ++i) {
      const std::string n = std::to_string(9 + i);  // 9 is before 10.
      WriteColor("scene/color/" + n + ".jpg", 10 * (i + 1), 128, 96);
      WriteDepth("scene/depth/" + n + ".png", 1000 * (i + 1));
      folder_.Write("scene/pose/" + n + ".txt", kPoseAtTwo);
    }
    folder_.Write("scene/intrinsic/intrinsic_depth.txt", kMatrix);
    folder_.Write("scene/intrinsic/intrinsic_color.txt",
                  "100 0 64 0\n0 100 48 0\n0 0 1 0\n0 0 0 1\n");
    folder_.Write("scene/intrinsic/extrinsic_depth.txt",
                  "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    folder_.Write("scene/intrinsic/extrinsic_color.txt",
                  "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
};

TEST_F(ScanNetData, HasTheSizesOfItsImages) {
  ExpectTwoFrames("scene", "scannet");
  const ImageFolderReader reader(folder_ / "scene");
  EXPECT_EQ(reader.camera().height, 48);
  ASSERT_TRUE(reader.calibration().color);
  EXPECT_EQ(reader.calibration().color->height, 96);
  ASSERT_EQ(reader.FindSequencePoses().size(), 2u);
  EXPECT_DOUBLE_EQ(reader.FindSequencePoses()[1].timestamp, 10 / 30.0);
}

TEST_F(ScanNetData, WithoutAColourCameraTheImagesMustBeRegistered) {
  std::filesystem::remove(folder_ / "scene/intrinsic/intrinsic_color.txt");
  ExpectRefused("scene", "auto", "9.jpg: image of 128x96: expected 64x48");
}

TEST_F(ScanNetData, BrokenFilesAreNamed) {
  const std::string color = "scene/intrinsic/intrinsic_color.txt";
  folder_.Write(color, "-1 0 64 0\n0 100 48 0\n0 0 1 0\n0 0 0 1\n");
  ExpectRefused("scene", "auto", "intrinsic_color.txt: '-1 0 64, 0 100 48, 0");
  const std::string place = "scene/intrinsic/extrinsic_color.txt";
  folder_.Write(place, "1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  ExpectRefused("scene", "auto", "extrinsic_color.txt: turned by '1 0 0, 0 1");
  std::filesystem::remove(folder_ / place);
  folder_.Write(color, "1 0\n");
  ExpectRefused("scene", "auto", "intrinsic_color.txt: a matrix of 1x2");
  std::filesystem::remove_all(folder_ / "scene/color");
  ExpectRefused("scene", "scannet", "no folder of colour images");
  folder_.Make("scene/color");
  ExpectRefused("scene", "scannet", "color: 0 images");
}

TEST_F(DataSets, DeepDeformHasAMatrix) {
  for (int i = 0; i < 2; ++i) {
    const std::string n = "00000" + std::to_string(i);
    WriteColor("seq000/color/" + n + ".jpg", 10 * (i + 1));
    WriteDepth("seq000/depth/" + n + ".png", 1000 * (i + 1));
  }
  folder_.Write("seq000/intrinsics.txt", kMatrix);
  ExpectTwoFrames("seq000", "deepdeform");
  EXPECT_EQ(ImageFolderReader(folder_ / "seq000").camera().fx, 50);
  EXPECT_FALSE(ImageFolderReader(folder_ / "seq000").calibration().color);
  folder_.Write("seq000/intrinsics.txt", "no\n");
  ExpectRefused("seq000", "auto", "intrinsics.txt:1: 'no': expected numbers");
}

constexpr char kJson[] =
    R"({"width": 64, "height": 48,
        "intrinsic_matrix": [50, 0, 0, 0, 51, 0, 31.5, 23.5, 1]})";

TEST_F(DataSets, RedwoodPairsByTime) {
  // A colour image before the first depth image, as in the recordings.
  WriteColor("chair/rgb/0000001-000000000000.jpg", 99);
  WriteColor("chair/rgb/0000002-000000033000.jpg", 10);
  WriteColor("chair/rgb/0000003-000000066000.jpg", 20);
  WriteDepth("chair/depth/0000001-000000034000.png", 1000);
  WriteDepth("chair/depth/0000002-000000067000.png", 2000);
  ExpectRefused("chair", "auto", "image of 64x48: expected 640x480");
  folder_.Write("chair/camera_intrinsic.json", kJson);
  ExpectTwoFrames("chair", "redwood");
  EXPECT_DOUBLE_EQ(
      ImageFolderReader(folder_ / "chair").pairs()[0].depth.timestamp, 0.034);
}

TEST_F(DataSets, Open3dPairsByNumberOrOrder) {
  for (int i = 0; i < 2; ++i) {
    const std::string n = "0000" + std::to_string(i);
    WriteColor("o/color/" + n + ".jpg", 10 * (i + 1));
    WriteDepth("o/depth/" + n + ".png", 1000 * (i + 1));
    WriteColor("p/image/c" + std::to_string(i + 7) + "x.png", 10 * (i + 1));
    WriteDepth("p/depth/" + n + ".png", 1000 * (i + 1));
  }
  ExpectRefused("o", "auto", "neither calibration.txt nor camera.txt");
  folder_.Write("o/intrinsic.json", kJson);
  folder_.Write("p/intrinsic.json", kJson);
  ExpectTwoFrames("o", "redwood");
  ExpectTwoFrames("p", "redwood");
  folder_.Write("o/trajectory.log", "1 1 2\n" + std::string(kPoseAtTwo));
  const Trajectory poses = ImageFolderReader(folder_ / "o").FindSequencePoses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_DOUBLE_EQ(poses[0].timestamp, 1 / 30.0);
  EXPECT_EQ(poses[0].world_from_camera.translation().x(), 2);
  folder_.Write("o/trajectory.log", "1 1 2\n1 0\n\n1\n2\n3\n");
  ExpectInputError(
      [&] { ImageFolderReader(folder_ / "o").FindSequencePoses(); },
      "trajectory.log:2: '1 0': expected 4 numbers");
  folder_.Write("o/trajectory.log", "1 1 2\n1 0 0 0\n");
  ExpectInputError(
      [&] { ImageFolderReader(folder_ / "o").FindSequencePoses(); },
      "trajectory.log: 2 lines: expected blocks of an index line");
  WriteDepth("p/depth/00002.png", 3000);
  ExpectRefused("p", "auto", "2 colour and 3 depth images");
  folder_.Write("o/intrinsic.json", "{");
  ExpectRefused("o", "auto", "intrinsic.json: expected a JSON object");
}

TEST_F(DataSets, DepthMayBeFloatingPointMetres) {
  for (const char* extension : {".tiff", ".exr"}) {
    const std::string name = std::string("f") + extension;
    for (int i = 0; i < 2; ++i) {
      const std::string n = std::to_string(i);
      WriteColor(name + "/rgb/" + n + ".jpg", 10 * (i + 1));
      cv::Mat depth(48, 64, CV_32FC1, cv::Scalar(i + 1));
      depth.row(0).setTo(std::nanf(""));
      depth.row(1).setTo(-1);
      folder_.Make(name + "/depth");
      cv::imwrite(folder_ / (name + "/depth/" + n + extension), depth);
    }
    folder_.Write(name + "/intrinsic.json", kJson);
    ExpectTwoFrames(name, "redwood");
    const Frame first = *ImageFolderReader(folder_ / name).Next();
    EXPECT_EQ(cv::countNonZero(first.depth.rowRange(0, 2)), 0);
  }
  folder_.Write("f.exr/depth/0.exr", "no image");
  ExpectRefused("f.exr", "auto", "0.exr: 8 bytes that are no image");
}

}  // namespace
}  // namespace splitfusion
