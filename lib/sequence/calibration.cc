#include "splitfusion/lib/sequence/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

void CheckCalibration(const std::string& path, const Calibration& calibration) {
  try {
    calibration.Check();
  } catch (const InputError& error) {
    throw InputError(path + ": " + error.what());
  }
}

/// The keys of camera.txt.
constexpr std::array<const char*, 7> kKeys = {
    "width", "height", "fx", "fy", "cx", "cy", "depth_scale"};

std::string KeyList() {
  std::string list;
  for (const char* key : kKeys)
    list += (list.empty() ? "" : ", ") + std::string(key);
  return list;
}

std::map<std::string, double> ReadKeys(const std::string& path) {
  std::map<std::string, double> values;
  for (const TextLine& line : ReadTextLines(path, /*cut_comments=*/true)) {
    std::istringstream words(line.text);
    std::string key;
    double value = 0;
    if (!(words >> key >> value) || !(words >> std::ws).eof()) {
      line.Refuse("'key value', the value a number");
    }
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end() ||
        !values.emplace(key, value).second) {
      throw InputError(line.place + ": key '" + key + "': expected " +
                       KeyList() + ", each once");
    }
  }
  return values;
}

double Require(const std::string& path,
               const std::map<std::string, double>& values,
               const std::string& key) {
  const auto found = values.find(key);
  if (found != values.end()) return found->second;
  throw InputError(path + ": no line '" + key + " VALUE': expected " +
                   KeyList());
}

}  // namespace

void Calibration::Check() const {
  camera.Check();
  CheckOption(std::isfinite(depth_scale) && depth_scale > 0, "depth scale",
              depth_scale, "positive units per metre (TUM: 5000)");
}

Calibration ReadCalibrationLine(const std::string& path) {
  const std::string expected = "'fx fy cx cy width height depth_factor'";
  const std::vector<TextLine> lines =
      ReadTextLines(path, /*cut_comments=*/true);
  if (lines.empty()) throw InputError(path + ": no line: expected " + expected);
  Calibration result;
  PinholeCamera& camera = result.camera;
  std::istringstream words(lines[0].text);
  if (!(words >> camera.fx >> camera.fy >> camera.cx >> camera.cy >>
        camera.width >> camera.height >> result.depth_scale) ||
      !(words >> std::ws).eof()) {
    lines[0].Refuse(expected);
  }
  CheckCalibration(path, result);
  return result;
}

void WriteCalibration(const std::string& path, const Calibration& calibration) {
  const PinholeCamera& camera = calibration.camera;
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << std::setprecision(17) << "# fx fy cx cy width height depth_factor\n"
        << camera.fx << ' ' << camera.fy << ' ' << camera.cx << ' ' << camera.cy
        << ' ' << camera.width << ' ' << camera.height << ' '
        << calibration.depth_scale << '\n';
  });
}

Calibration ReadCalibrationKeys(const std::string& path) {
  const std::map<std::string, double> values = ReadKeys(path);
  Calibration result;
  result.camera.width = static_cast<int>(Require(path, values, "width"));
  result.camera.height = static_cast<int>(Require(path, values, "height"));
  result.camera.fx = Require(path, values, "fx");
  result.camera.fy = Require(path, values, "fy");
  result.camera.cx = Require(path, values, "cx");
  result.camera.cy = Require(path, values, "cy");
  result.depth_scale = Require(path, values, "depth_scale");
  CheckCalibration(path, result);
  return result;
}

std::optional<Calibration> FindCalibration(const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path line_file = fs::path(folder) / "calibration.txt";
  if (fs::exists(line_file)) return ReadCalibrationLine(line_file.string());
  const fs::path key_file = fs::path(folder) / "camera.txt";
  if (fs::exists(key_file)) return ReadCalibrationKeys(key_file.string());
  return std::nullopt;
}

}  // namespace splitfusion
