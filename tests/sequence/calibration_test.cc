#include "splitfusion/lib/sequence/calibration.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

constexpr char kKeys[] =
    "# pinhole\nwidth 640\nheight 480\nfx 517.3\nfy 516.5\ncx 318.6\n"
    "cy 255.3\n\ndepth_scale 5000\n";

TEST(Calibration, ReadsTheOneLineFormat) {
  const TemporaryFolder folder;
  const std::string path =
      folder.Write("calibration.txt",
                   "# fx fy cx cy width height depth_factor\n"
                   "535.4 539.2 320.1 247.6 640 480 1000  # Kinect\n");
  const Calibration calibration = ReadCalibrationLine(path);
  EXPECT_EQ(calibration.camera.width, 640);
  EXPECT_EQ(calibration.camera.height, 480);
  EXPECT_DOUBLE_EQ(calibration.camera.fx, 535.4);
  EXPECT_DOUBLE_EQ(calibration.camera.cy, 247.6);
  EXPECT_DOUBLE_EQ(calibration.depth_scale, 1000);
}

TEST(Calibration, ReadsTheKeyFormat) {
  const TemporaryFolder folder;
  const Calibration calibration =
      ReadCalibrationKeys(folder.Write("camera.txt", kKeys));
  EXPECT_EQ(calibration.camera.height, 480);
  EXPECT_DOUBLE_EQ(calibration.camera.fy, 516.5);
  EXPECT_DOUBLE_EQ(calibration.camera.cx, 318.6);
  EXPECT_DOUBLE_EQ(calibration.depth_scale, 5000);
}

TEST(Calibration, IsFoundInEitherFormatOrNotAtAll) {
  const TemporaryFolder folder;
  EXPECT_FALSE(FindCalibration(folder / "").has_value());
  folder.Write("camera.txt", kKeys);
  EXPECT_DOUBLE_EQ(FindCalibration(folder / "")->camera.fx, 517.3);
  folder.Write("calibration.txt", "500 500 320 240 640 480 1000\n");
  EXPECT_DOUBLE_EQ(FindCalibration(folder / "")->camera.fx, 500);
}

TEST(Calibration, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto line = [&](const std::string& text) {
    return [path = folder.Write("calibration.txt", text)] {
      ReadCalibrationLine(path);
    };
  };
  ExpectInputError(line("500 500 320 240 640\n"), "calibration.txt:1");
  ExpectInputError(line("500 500 320 240 640 480 1000 0.1\n"),
                   "calibration.txt:1");
  ExpectInputError(line("# nothing\n"), "no line");
  ExpectInputError(line("-500 500 320 240 640 480 5000\n"), "camera fx = -500");
  ExpectInputError(line("500 500 320 240 640 480 0\n"), "depth scale = 0");
  ExpectInputError([&] { ReadCalibrationLine(folder / "none.txt"); },
                   "none.txt: cannot be opened");
}

TEST(Calibration, NamesTheMissingKey) {
  const TemporaryFolder folder;
  const std::string path =
      folder.Write("camera.txt", "width 640\nheight 480\nfx 500\n");
  ExpectInputError([&] { ReadCalibrationKeys(path); }, "'fy VALUE'");
  folder.Write("camera.txt", "width wide\n");
  ExpectInputError([&] { ReadCalibrationKeys(path); }, "'width wide'");
}

TEST(Calibration, MayHaveALens) {
  const TemporaryFolder folder;
  const Calibration found = ReadCalibrationKeys(folder.Write(
      "camera.txt", kKeys + std::string("k1 0.25\np1 -0.5\nk6 0.125\n")));
  const std::array<double, 8> expected = {0.25, 0, -0.5, 0, 0, 0, 0, 0.125};
  EXPECT_EQ(found.lens.coefficients, expected);
  EXPECT_FALSE(found.color);
  const std::string bad =
      folder.Write("camera.txt", kKeys + std::string("k1 1e999\n"));
  ExpectInputError([&] { ReadCalibrationKeys(bad); }, "camera.txt");
}

TEST(Calibration, WithAColourCameraIsReadAsItWasWritten) {
  const TemporaryFolder folder;
  Calibration written = ReadCalibrationKeys(folder.Write("a.txt", kKeys));
  written.lens.coefficients = {0.1, -0.2, 0.001, 0.002, 0.3, 0, 0, 0};
  written.color_lens.coefficients = {0.4, 0, 0, 0, 0, 0.5, 0, 0};
  ColorCamera& color = written.color.emplace();
  color.width = 1296;
  color.height = 968;
  color.fx = 1170.2;
  color.fy = 1171.3;
  color.cx = 647.75;
  color.cy = 483.5;
  color.color_from_depth.linear() =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  color.color_from_depth.translation() = Eigen::Vector3d(-0.025, 0.001, 0);
  const std::string path = folder / "camera.txt";
  WriteCalibrationKeys(path, written);
  const Calibration read = ReadCalibrationKeys(path);
  EXPECT_EQ(read.lens.coefficients, written.lens.coefficients);
  EXPECT_EQ(read.color_lens.coefficients, written.color_lens.coefficients);
  ASSERT_TRUE(read.color);
  EXPECT_EQ(read.color->width, 1296);
  EXPECT_EQ(read.color->fy, 1171.3);
  EXPECT_EQ(read.color->cx, 647.75);
  EXPECT_TRUE(
      read.color->color_from_depth.isApprox(color.color_from_depth, 1e-12));
}

TEST(Calibration, AColourCameraIsWholeOrNotThere) {
  const TemporaryFolder folder;
  const std::string path =
      folder.Write("camera.txt", kKeys + std::string("color_width 1296\n"));
  ExpectInputError([&] { ReadCalibrationKeys(path); },
                   "camera.txt: no line 'color_height VALUE'");
}

TEST(Calibration, ASizeIsANumberOfPixels) {
  const TemporaryFolder folder;
  for (const char* size : {"0", "-3", "12.5", "1e9"}) {
    const std::string path = folder.Write(
        "camera.txt", kKeys +
                          std::string("color_height 968\ncolor_fx 1\n"
                                      "color_fy 1\ncolor_cx 1\n"
                                      "color_cy 1\ncolor_width ") +
                          size + "\n");
    ExpectInputError([&] { ReadCalibrationKeys(path); },
                     "expected a number of pixels");
  }
}

TEST(Calibration, NamesKeysThatNobodyReads) {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& line) {
    return [path = folder.Write("camera.txt", kKeys + line)] {
      ReadCalibrationKeys(path);
    };
  };
  EXPECT_NO_THROW(with("# k9 0.2\n")());
  ExpectInputError(with("k9 0.2\n"), "key 'k9': expected width, height");
  ExpectInputError(with("color_k9 0.2\n"), "key 'color_k9': expected width");
  ExpectInputError(with("fx 500\n"), "key 'fx'");
  ExpectInputError(with("fx 500 501\n"), "'fx 500 501'");
}

}  // namespace
}  // namespace splitfusion
