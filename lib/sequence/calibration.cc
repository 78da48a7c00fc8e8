#include "splitfusion/lib/sequence/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <map>
#include <sstream>
#include <utility>

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

using KeyValues = std::map<std::string, double>;

/// The keys that camera.txt must have.
constexpr std::array<const char*, 7> kKeys = {
    "width", "height", "fx", "fy", "cx", "cy", "depth_scale"};
/// Those of a colour camera, after kColorPrefix: that it must have, and may.
constexpr std::array<const char*, 6> kColorKeys = {"width", "height", "fx",
                                                   "fy",    "cx",     "cy"};
constexpr std::array<const char*, 7> kPoseKeys = {"tx", "ty", "tz", "qx",
                                                  "qy", "qz", "qw"};
const std::string kColorPrefix = "color_";

template <typename Keys>
bool HasKey(const Keys& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

bool IsKnownKey(const std::string& key) {
  if (HasKey(kKeys, key) || HasKey(kDistortionKeys, key)) return true;
  if (key.rfind(kColorPrefix, 0) != 0) return false;
  const std::string rest = key.substr(kColorPrefix.size());
  return HasKey(kColorKeys, rest) || HasKey(kPoseKeys, rest) ||
         HasKey(kDistortionKeys, rest);
}

std::string KeyList() {
  std::string list;
  for (const char* key : kKeys)
    list += (list.empty() ? "" : ", ") + std::string(key);
  return list + ", k1 to k6, p1, p2";
}

KeyValues ReadKeys(const std::string& path) {
  KeyValues values;
  for (const TextLine& line : ReadTextLines(path, /*cut_comments=*/true)) {
    std::istringstream words(line.text);
    std::string key;
    double value = 0;
    if (!(words >> key >> value) || !(words >> std::ws).eof()) {
      line.Refuse("'key value', the value a number");
    }
    if (!IsKnownKey(key) || !values.emplace(key, value).second) {
      throw InputError(line.place + ": key '" + key + "': expected " +
                       KeyList() + ", or color_... of them, each once");
    }
  }
  return values;
}

double Require(const std::string& path, const KeyValues& values,
               const std::string& key) {
  const auto found = values.find(key);
  if (found != values.end()) return found->second;
  throw InputError(path + ": no line '" + key + " VALUE': expected " +
                   KeyList());
}

int RequireSize(const std::string& path, const KeyValues& values,
                const std::string& key) {
  constexpr double kMost = 1e6;  // Format: none has more.
  const double size = Require(path, values, key);
  CheckOption(size >= 1 && size <= kMost && size == std::floor(size),
              path + ": " + key, size, "a number of pixels");
  return static_cast<int>(size);
}

double ValueOr(const KeyValues& values, const std::string& key,
               double otherwise) {
  const auto found = values.find(key);
  return found == values.end() ? otherwise : found->second;
}

LensDistortion LensOfKeys(const KeyValues& values, const std::string& prefix) {
  LensDistortion lens;
  for (std::size_t i = 0; i < kDistortionKeys.size(); ++i) {
    lens.coefficients[i] = ValueOr(values, prefix + kDistortionKeys[i], 0);
  }
  return lens;
}

/// The colour camera of camera.txt, if there is any key of one.
std::optional<ColorCamera> ColorCameraOfKeys(const std::string& path,
                                             const KeyValues& values) {
  const auto first = values.lower_bound(kColorPrefix);
  if (first == values.end() || first->first.rfind(kColorPrefix, 0) != 0) {
    return std::nullopt;
  }
  const auto require = [&](const char* key) {
    return Require(path, values, kColorPrefix + key);
  };
  const auto value = [&](const char* key, double otherwise) {
    return ValueOr(values, kColorPrefix + key, otherwise);
  };
  ColorCamera color;
  color.width = RequireSize(path, values, kColorPrefix + "width");
  color.height = RequireSize(path, values, kColorPrefix + "height");
  color.fx = require("fx");
  color.fy = require("fy");
  color.cx = require("cx");
  color.cy = require("cy");
  const Eigen::Quaterniond q(value("qw", 1), value("qx", 0), value("qy", 0),
                             value("qz", 0));
  CheckOption(q.norm() > 0, path + ": quaternion of the colour camera",
              q.norm(), "one that is not 0");
  color.color_from_depth.linear() = q.normalized().toRotationMatrix();
  color.color_from_depth.translation() << value("tx", 0), value("ty", 0),
      value("tz", 0);
  return color;
}

void WriteLensKeys(const std::string& prefix, const LensDistortion& lens,
                   std::ostream& out) {
  for (std::size_t i = 0; i < kDistortionKeys.size(); ++i) {
    if (lens.coefficients[i] == 0) continue;
    out << prefix << kDistortionKeys[i] << ' ' << lens.coefficients[i] << '\n';
  }
}

void WriteColorKeys(const ColorCamera& color, std::ostream& out) {
  const Eigen::Vector3d t = color.color_from_depth.translation();
  const Eigen::Quaterniond q(color.color_from_depth.linear());
  const std::pair<const char*, double> values[] = {
      {"fx", color.fx}, {"fy", color.fy}, {"cx", color.cx}, {"cy", color.cy},
      {"tx", t.x()},    {"ty", t.y()},    {"tz", t.z()},    {"qx", q.x()},
      {"qy", q.y()},    {"qz", q.z()},    {"qw", q.w()}};
  out << kColorPrefix << "width " << color.width << '\n'
      << kColorPrefix << "height " << color.height << '\n';
  for (const auto& [key, value] : values) {
    out << kColorPrefix << key << ' ' << value << '\n';
  }
}

}  // namespace

void Calibration::Check() const {
  camera.Check();
  CheckOption(std::isfinite(depth_scale) && depth_scale > 0, "depth scale",
              depth_scale, "positive units per metre (TUM: 5000)");
  if (color) color->Check();
  lens.Check();
  color_lens.Check();
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
  const KeyValues values = ReadKeys(path);
  Calibration result;
  result.camera.width = RequireSize(path, values, "width");
  result.camera.height = RequireSize(path, values, "height");
  result.camera.fx = Require(path, values, "fx");
  result.camera.fy = Require(path, values, "fy");
  result.camera.cx = Require(path, values, "cx");
  result.camera.cy = Require(path, values, "cy");
  result.depth_scale = Require(path, values, "depth_scale");
  result.lens = LensOfKeys(values, "");
  result.lens_is_stated =
      std::any_of(kDistortionKeys.begin(), kDistortionKeys.end(),
                  [&](const char* key) { return values.count(key) > 0; });
  result.color = ColorCameraOfKeys(path, values);
  result.color_lens = LensOfKeys(values, kColorPrefix);
  CheckCalibration(path, result);
  return result;
}

void WriteCalibrationKeys(const std::string& path,
                          const Calibration& calibration) {
  const PinholeCamera& camera = calibration.camera;
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << std::setprecision(17) << "width " << camera.width << "\nheight "
        << camera.height << "\nfx " << camera.fx << "\nfy " << camera.fy
        << "\ncx " << camera.cx << "\ncy " << camera.cy << "\ndepth_scale "
        << calibration.depth_scale << '\n';
    if (calibration.lens.IsNone()) out << "k1 0\n";  // It is stated.
    WriteLensKeys("", calibration.lens, out);
    if (!calibration.color) return;
    WriteColorKeys(*calibration.color, out);
    WriteLensKeys(kColorPrefix, calibration.color_lens, out);
  });
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
