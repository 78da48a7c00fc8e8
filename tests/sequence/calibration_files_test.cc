#include "splitfusion/lib/sequence/calibration_files.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "support/expect_input_error.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

class CalibrationFiles : public ::testing::Test {
 protected:
  /// What a file of that content says.
  Calibration Read(const std::string& name, const std::string& text) {
    return ReadForeignCalibration(folder_.Write(name, text));
  }
  void ExpectRefused(const std::string& name, const std::string& text,
                     const std::string& message) {
    const std::string path = folder_.Write(name, text);
    ExpectInputError([&] { ReadForeignCalibration(path); },
                     path.substr(path.rfind('/')) + message);
  }
  static void ExpectCamera(const Calibration& found, int width, int height) {
    EXPECT_EQ(found.camera.width, width);
    EXPECT_EQ(found.camera.height, height);
    EXPECT_DOUBLE_EQ(found.camera.fx, 575.5);
    EXPECT_DOUBLE_EQ(found.camera.fy, 577.25);
    EXPECT_DOUBLE_EQ(found.camera.cx, 323.125);
    EXPECT_DOUBLE_EQ(found.camera.cy, 236.75);
  }

  TemporaryFolder folder_;
};

constexpr char kRosYaml[] =
    "image_width: 640\n"
    "image_height: 480\n"
    "camera_name: rgb_camera\n"
    "camera_matrix:\n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  data: [575.5, 0, 323.125, 0, 577.25, 236.75, 0, 0, 1]\n"
    "distortion_model: plumb_bob\n"
    "distortion_coefficients:\n"
    "  rows: 1\n"
    "  cols: 5\n"
    "  data: [0.25, -0.5, 0.001, 0.002, 0.125]\n"
    "rectification_matrix:\n"
    "  rows: 3\n"
    "  cols: 3\n"
    "  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";

TEST_F(CalibrationFiles, AMatrixOfThreeOrFourRows) {
  const Calibration three =
      Read("k.txt", "575.5 0 323.125\n0 577.25 236.75\n0 0 1\n");
  ExpectCamera(three, 0, 0);
  EXPECT_EQ(three.depth_scale, 0);
  ExpectCamera(Read("k.txt",
                    "# by the maker\n575.5, 0, 323.125, 0\n"
                    "0, 577.25, 236.75, 0\n0 0 1 0\n0 0 0 1\n"),
               0, 0);
}

TEST_F(CalibrationFiles, TheJsonOfOpen3d) {
  const Calibration found =
      Read("intrinsic.json",
           R"({"width": 640, "height": 480, "depth_scale": 1000.0,
               "intrinsic_matrix": [575.5, 0, 0, 0, 577.25, 0,
                                    323.125, 236.75, 1]})");
  ExpectCamera(found, 640, 480);
  EXPECT_EQ(found.depth_scale, 1000);
}

TEST_F(CalibrationFiles, TheYamlOfRos) {
  const Calibration found = Read("camera.yaml", kRosYaml);
  ExpectCamera(found, 640, 480);
  EXPECT_EQ(found.lens.coefficients[0], 0.25);
  EXPECT_EQ(found.lens.coefficients[3], 0.002);
  EXPECT_EQ(found.lens.coefficients[4], 0.125);
  ExpectCamera(Read("info.yaml",
                    "height: 480\nwidth: 640\ndistortion_model: \"plumb_bob\"\n"
                    "D: [0.0, 0.0, 0.0, 0.0, 0.0]\n"
                    "K: [575.5, 0.0, 323.125, 0.0, 577.25, 236.75, 0, 0, 1]\n"),
               640, 480);
}

TEST_F(CalibrationFiles, TheYamlThatOpenCvWrites) {
  const std::string path = folder_ / "camera.yml";
  {
    cv::FileStorage file(path, cv::FileStorage::WRITE);
    file << "image_width" << 640 << "image_height" << 480;
    file << "camera_matrix"
         << cv::Mat(cv::Matx33d(575.5, 0, 323.125, 0, 577.25, 236.75, 0, 0, 1));
    file << "distortion_coefficients"
         << cv::Mat(cv::Matx<double, 1, 8>(1, 2, 3, 4, 5, 6, 7, 8));
  }
  const Calibration found = ReadForeignCalibration(path);
  ExpectCamera(found, 640, 480);
  EXPECT_EQ(found.lens.coefficients[7], 8);
}

TEST_F(CalibrationFiles, AreFoundInAFolder) {
  EXPECT_FALSE(FindForeignCalibration(folder_ / ""));
  folder_.Write("intrinsics.txt", "1 0 2\n0 3 4\n0 0 1\n");
  EXPECT_EQ(FindForeignCalibration(folder_ / "")->camera.cy, 4);
  folder_.Write("camera.yaml", kRosYaml);
  EXPECT_EQ(FindForeignCalibration(folder_ / "")->camera.cy, 236.75)
      << "has more to say";
}

TEST_F(CalibrationFiles, BrokenMatricesAreNamed) {
  ExpectRefused("k.txt", "", ": a matrix of 0x0: expected 3x3 or 4x4");
  ExpectRefused("k.txt", "1 0 2\n0 3 x\n0 0 1\n",
                ":2: '0 3 x': expected numbers");
  ExpectRefused("k.txt", "1 0 2\n0 3\n", ":2: '0 3': expected a row");
  ExpectRefused("k.txt", "1 2 3 4 5\n", ":1: '1 2 3 4 5': expected a row");
  ExpectRefused("k.txt", "1 0 2\n0 -3 4\n0 0 1\n",
                ": '1 0 2, 0 -3 4, 0 0 1': expected a matrix of intrinsics");
  ExpectRefused("k.txt", "1 0 2\n0 3 4\n0 0 7\n",
                ": '1 0 2, 0 3 4, 0 0 7': expected a matrix of intrinsics");
}

TEST_F(CalibrationFiles, BrokenJsonIsNamed) {
  ExpectRefused("c.json", "", ": expected a JSON object of a camera");
  ExpectRefused("c.json", "[1, 2", ": expected a JSON object of a camera");
  ExpectRefused("c.json", "{}", ": no list 'intrinsic_matrix'");
  ExpectRefused("c.json", R"({"intrinsic_matrix": [1, 2]})",
                ": 2 numbers: expected a matrix of 3x3 or 4x4");
  ExpectRefused("c.json", R"({"intrinsic_matrix": [1, "x"]})",
                ": 'intrinsic_matrix': expected numbers");
  ExpectRefused("c.json", R"({"width": "640", "intrinsic_matrix": [1]})",
                ": 'width': expected a number");
  ExpectRefused("c.json", R"({"width": 1e30, "intrinsic_matrix": [1]})",
                ": 'width' = 1e+30: expected a size in pixels");
}

TEST_F(CalibrationFiles, BrokenYamlIsNamed) {
  ExpectRefused("c.yaml", "", ": expected YAML");
  ExpectRefused("c.yaml", "{[", ": expected YAML");
  ExpectRefused("c.yaml", "image_width: 640\n", ": expected YAML");
  ExpectRefused("c.yaml", "K: [1, two]\n", ": 'K': expected numbers");
  std::string fisheye = kRosYaml;
  fisheye.replace(fisheye.find("plumb_bob"), 9, "equidistant");
  ExpectRefused("c.yaml", fisheye,
                ": distortion 'equidistant' of 5 coefficients: expected "
                "plumb_bob or rational_polynomial");
}

TEST_F(CalibrationFiles, AMotionIsRigid) {
  const std::string rows = "0 -1 0 2\n1 0 0 3\n0 0 1 4\n0 0 0 1\n";
  const auto motion =
      RigidMotion("m", ReadMatrix(folder_.Write("m.txt", rows), 4, 4));
  ASSERT_TRUE(motion);
  EXPECT_TRUE(
      (*motion * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(2, 4, 4)));
  const cv::Mat_<double> unknown =
      ReadMatrix(folder_.Write("m.txt",
                               "-inf -inf -inf -inf\n-inf -inf -inf -inf\n"
                               "-inf -inf -inf -inf\n-inf -inf -inf -inf\n"),
                 4, 4);
  EXPECT_FALSE(RigidMotion("m", unknown));
  const cv::Mat_<double> zeros = cv::Mat_<double>::zeros(4, 4);
  ExpectInputError([&] { RigidMotion("m.txt", zeros); },
                   "m.txt: turned by '0 0 0, 0 0 0, 0 0 0': expected a rigid");
}

}  // namespace
}  // namespace splitfusion
