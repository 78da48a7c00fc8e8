#include "splitfusion/lib/sequence/info_file.h"

#include <cmath>
#include <map>
#include <sstream>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"
#include "splitfusion/lib/sequence/calibration_files.h"

namespace splitfusion {
namespace {

using InfoLines = std::map<std::string, TextLine>;

constexpr char kDepthShift[] = "m_depthShift";

/// Lines `key = value` by key, the value as text.
InfoLines ReadInfoLines(const std::string& path) {
  InfoLines lines;
  for (TextLine line : ReadTextLines(path)) {
    const std::size_t equals = line.text.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = Trimmed(line.text.substr(0, equals));
    line.text = Trimmed(line.text.substr(equals + 1));
    lines.emplace(key, line);
  }
  return lines;
}

std::vector<double> InfoNumbers(const std::string& path, const InfoLines& lines,
                                const std::string& key) {
  const auto found = lines.find(key);
  if (found == lines.end()) {
    throw InputError(path + ": no line '" + key +
                     " = ...': expected the info.txt of BundleFusion");
  }
  std::istringstream words(found->second.text);
  std::vector<double> numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  if (numbers.empty() || !words.eof()) found->second.Refuse("numbers");
  return numbers;
}

int InfoSize(const std::string& path, const InfoLines& lines,
             const std::string& key) {
  constexpr double kMost = 1e5;
  const double size = InfoNumbers(path, lines, key).front();
  if (size >= 1 && size <= kMost && size == std::floor(size)) {
    return static_cast<int>(size);
  }
  lines.at(key).Refuse("a size in pixels");
}

/// Of 4x4 numbers; some writers leave the last row out.
cv::Mat_<double> InfoMatrix(const std::string& path, const InfoLines& lines,
                            const std::string& key) {
  std::vector<double> numbers = InfoNumbers(path, lines, key);
  if (numbers.size() == 12) numbers.insert(numbers.end(), {0, 0, 0, 1});
  if (numbers.size() != 16) lines.at(key).Refuse("a matrix of 4x4");
  return cv::Mat(numbers, /*copyData=*/true).reshape(1, 4);
}

Rigid3d InfoExtrinsic(const std::string& path, const InfoLines& lines,
                      const std::string& key) {
  if (lines.count(key) == 0) return Rigid3d::Identity();
  return KnownRigidMotion(path + ": " + key, InfoMatrix(path, lines, key));
}

}  // namespace

Calibration CalibrationOf(const std::string& color_place,
                          const std::string& depth_place,
                          const TwoCameras& cameras) {
  Calibration result;
  result.depth_scale = cameras.depth_scale;
  result.camera.width = cameras.depth_size.width;
  result.camera.height = cameras.depth_size.height;
  SetIntrinsics(depth_place, cameras.depth_intrinsic, &result.camera);
  PinholeCamera color;
  SetIntrinsics(color_place, cameras.color_intrinsic, &color);
  ColorCamera beside = ColorCamera::Registered(color);
  beside.width = cameras.color_size.width;
  beside.height = cameras.color_size.height;
  beside.color_from_depth =
      cameras.color_extrinsic.inverse() * cameras.depth_extrinsic;
  const bool same_place =
      beside.color_from_depth.isApprox(Rigid3d::Identity(), 1e-9);
  const bool same_camera =
      color.fx == result.camera.fx && color.fy == result.camera.fy &&
      color.cx == result.camera.cx && color.cy == result.camera.cy;
  const bool registered =
      same_place && same_camera && cameras.color_size == cameras.depth_size;
  if (!registered) result.color = beside;
  return result;
}

Calibration ReadInfoFile(const std::string& path) {
  const InfoLines lines = ReadInfoLines(path);
  const auto size = [&](const std::string& camera) {
    return cv::Size(InfoSize(path, lines, "m_" + camera + "Width"),
                    InfoSize(path, lines, "m_" + camera + "Height"));
  };
  TwoCameras cameras;
  cameras.color_size = size("color");
  cameras.depth_size = size("depth");
  const std::string color = "m_calibrationColorIntrinsic";
  const std::string depth = "m_calibrationDepthIntrinsic";
  cameras.color_intrinsic = InfoMatrix(path, lines, color);
  cameras.depth_intrinsic = InfoMatrix(path, lines, depth);
  cameras.color_extrinsic =
      InfoExtrinsic(path, lines, "m_calibrationColorExtrinsic");
  cameras.depth_extrinsic =
      InfoExtrinsic(path, lines, "m_calibrationDepthExtrinsic");
  cameras.depth_scale = InfoNumbers(path, lines, kDepthShift).front();
  if (!(cameras.depth_scale > 0)) {
    lines.at(kDepthShift).Refuse("depth units in a metre, a number > 0");
  }
  return CalibrationOf(path + ": " + color, path + ": " + depth, cameras);
}

}  // namespace splitfusion
