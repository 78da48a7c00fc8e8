#include "splitfusion/lib/sequence/color_camera.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

TEST(ColorCamera, IsReadAsItWasWritten) {
  const TemporaryFolder folder;
  ColorCamera camera;
  camera.fx = 525.1;
  camera.fy = 526.2;
  camera.cx = 319.3;
  camera.cy = 240.4;
  camera.color_from_depth.linear() =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitY()).toRotationMatrix();
  camera.color_from_depth.translation() = Eigen::Vector3d(-0.025, 0.001, 0);
  const std::string path = folder / "color_camera.txt";
  WriteColorCamera(path, camera);
  const ColorCamera read = ReadColorCamera(path);
  EXPECT_DOUBLE_EQ(read.fx, 525.1);
  EXPECT_DOUBLE_EQ(read.cy, 240.4);
  EXPECT_TRUE(read.color_from_depth.isApprox(camera.color_from_depth, 1e-12));
  EXPECT_EQ(read.SizeBeside({640, 480}), cv::Size(640, 480));
  camera.width = 1296;
  camera.height = 968;
  WriteColorCamera(path, camera);
  EXPECT_EQ(ReadColorCamera(path).SizeBeside({640, 480}), cv::Size(1296, 968));
}

TEST(ColorCamera, NamesWhatIsWrong) {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& text) {
    return [path = folder.Write("color_camera.txt", text)] {
      ReadColorCamera(path);
    };
  };
  ExpectInputError(file("# nothing\n"), "no line");
  ExpectInputError(file("525 525 320 240 0 0 0\n"), "color_camera.txt:1");
  ExpectInputError(file("525 525 320 240 0 0 0 0 0 0 1 7\n"),
                   "color_camera.txt:1");
  ExpectInputError(file("525 525 320 240 0 0 0 0 0 0 1 640 0\n"),
                   "size of the colour camera = 640x0: expected two positive");
  ExpectInputError(file("-525 525 320 240 0 0 0 0 0 0 1\n"),
                   "fx of the colour camera");
  ExpectInputError(file("525 525 320 240 0 0 0 0 0 0 0\n"),
                   "quaternion of the colour camera");
  ExpectInputError(file("525 525 320 240 0 0 0 0 0 0 1\n1 2 3\n"),
                   "color_camera.txt:2");
  ExpectInputError(file("525 525 320 240 9 0 0 0 0 0 1\n"),
                   "way to the colour camera = 9: expected 1 m at most");
  ExpectInputError(file("525 525 320 240 0 0 0 0 1 0 0\n"),
                   "view of the colour camera = -1: expected one ahead");
}

}  // namespace
}  // namespace splitfusion
