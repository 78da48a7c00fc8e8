#include "splitfusion/lib/sequence/calibration_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/text_file.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxCalibrationBytes = 1 << 20;

/// In order of precedence.
constexpr const char* kForeignFiles[] = {
    "camera.yaml",      "camera.yml",
    "camera_info.yaml", "calibration.yaml",
    "intrinsics.yaml",  "camera_intrinsic.json",
    "intrinsic.json",   "intrinsics.json",
    "camera.json",      "camera_intrinsics.json",
    "intrinsics.txt",   "intrinsic.txt"};

/// All of a small text file.
std::string ReadWhole(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) ||
      fs::file_size(path, error) > kMaxCalibrationBytes) {
    throw InputError(path +
                     ": expected a file of intrinsics, of 1 MiB at most");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path + ": cannot be opened");
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Numbers of a line, separated by blanks or commas.
std::vector<double> RowOf(const TextLine& line) {
  std::string text = line.text;
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    std::size_t end = 0;
    try {
      numbers.push_back(std::stod(word, &end));  // Knows "-inf", too.
    } catch (const std::exception&) {
      end = 0;
    }
    if (end != word.size()) line.Refuse("numbers");
  }
  return numbers;
}

/// A matrix from the elements, which lie row by row.
cv::Mat_<double> SquareMatrix(const std::string& place,
                              const std::vector<double>& elements) {
  if (elements.size() != 9 && elements.size() != 16) {
    throw InputError(place + ": " + std::to_string(elements.size()) +
                     " numbers: expected a matrix of 3x3 or 4x4");
  }
  const int size = elements.size() == 9 ? 3 : 4;
  cv::Mat_<double> matrix(size, size);
  std::copy(elements.begin(), elements.end(), matrix.begin());
  return matrix;
}

using CameraJson = nlohmann::json;

/// The upper left 3x3 of a matrix, rows separated by commas.
std::string RowsText(const cv::Mat_<double>& matrix) {
  std::ostringstream text;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) text << (j > 0 ? " " : "") << matrix(i, j);
    if (i < 2) text << ", ";
  }
  return text.str();
}

/// A number of a JSON object; `otherwise` if there is none of that name.
double JsonNumber(const std::string& path, const CameraJson& object,
                  const std::string& key, double otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  if (found->is_number()) return found->get<double>();
  throw InputError(path + ": '" + key + "': expected a number");
}

int JsonSize(const std::string& path, const CameraJson& object,
             const std::string& key) {
  constexpr double kMost = 1e6;
  const double size = JsonNumber(path, object, key, 0);
  if (size >= 0 && size <= kMost && size == std::floor(size)) {
    return static_cast<int>(size);
  }
  std::ostringstream text;
  text << path << ": '" << key << "' = " << size
       << ": expected a size in pixels";
  throw InputError(text.str());
}

std::vector<double> JsonNumbers(const std::string& path,
                                const CameraJson& object,
                                const std::string& key) {
  std::vector<double> numbers;
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array()) {
    throw InputError(path + ": no list '" + key +
                     "': expected Open3D's width, height, intrinsic_matrix");
  }
  for (const CameraJson& item : *found) {
    if (!item.is_number()) {
      throw InputError(path + ": '" + key + "': expected numbers");
    }
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

Calibration ReadJsonCalibration(const std::string& path) {
  const CameraJson json = CameraJson::parse(ReadWhole(path), nullptr, false);
  if (!json.is_object()) {
    throw InputError(path + ": expected a JSON object of a camera");
  }
  // Open3D writes a pinhole trajectory's camera as a member.
  const auto inner = json.find("intrinsic");
  const CameraJson& camera =
      inner != json.end() && inner->is_object() ? *inner : json;
  Calibration result;
  result.camera.width = JsonSize(path, camera, "width");
  result.camera.height = JsonSize(path, camera, "height");
  result.depth_scale = JsonNumber(path, json, "depth_scale", 0);
  const cv::Mat_<double> columns =
      SquareMatrix(path, JsonNumbers(path, camera, "intrinsic_matrix"));
  SetIntrinsics(path, cv::Mat(columns.t()), &result.camera);
  return result;
}

/// A list of numbers, or the `data` of a matrix.
std::vector<double> YamlNumbers(const std::string& path,
                                const cv::FileNode& node) {
  const cv::FileNode list = node.isMap() ? node["data"] : node;
  std::vector<double> numbers;
  if (!list.isSeq()) return numbers;
  for (const cv::FileNode item : list) {
    if (!item.isInt() && !item.isReal()) {
      throw InputError(path + ": '" + node.name() + "': expected numbers");
    }
    numbers.push_back(static_cast<double>(item));
  }
  return numbers;
}

/// The first of the names that is there; none if there is none.
cv::FileNode YamlNode(const cv::FileStorage& file,
                      const std::vector<const char*>& names) {
  for (const char* name : names) {
    const cv::FileNode node = file[name];
    if (!node.empty() && !node.isNone()) return node;
  }
  return {};
}

int YamlSize(const cv::FileStorage& file,
             const std::vector<const char*>& names) {
  const cv::FileNode node = YamlNode(file, names);
  return node.isInt() ? static_cast<int>(node) : 0;
}

LensDistortion YamlLens(const std::string& path, const cv::FileStorage& file) {
  const cv::FileNode model = YamlNode(file, {"distortion_model"});
  const std::string name =
      model.isString() ? static_cast<std::string>(model) : "plumb_bob";
  const std::vector<double> numbers = YamlNumbers(
      path, YamlNode(file, {"distortion_coefficients",
                            "Distortion_Coefficients", "dist_coeffs", "D"}));
  return MakeLensDistortion(path, name, numbers);
}

[[noreturn]] void FailAsYaml(const std::string& path) {
  throw InputError(path +
                   ": expected YAML with image_width, image_height, "
                   "camera_matrix, as OpenCV and ROS write it");
}

Calibration ReadYamlCalibration(const std::string& path) {
  std::string text = ReadWhole(path);
  if (text.rfind("%YAML", 0) != 0) {  // That of ROS has no such line.
    if (text.rfind("---", 0) != 0) text = "---\n" + text;
    text = "%YAML:1.0\n" + text;
  }
  Calibration result;
  try {
    const cv::FileStorage file(text, cv::FileStorage::READ |
                                         cv::FileStorage::MEMORY |
                                         cv::FileStorage::FORMAT_YAML);
    const cv::FileNode matrix =
        YamlNode(file, {"camera_matrix", "Camera_Matrix", "cameraMatrix", "K"});
    result.camera.width =
        YamlSize(file, {"image_width", "image_Width", "width"});
    result.camera.height =
        YamlSize(file, {"image_height", "image_Height", "height"});
    const std::vector<double> elements = YamlNumbers(path, matrix);
    if (elements.empty()) FailAsYaml(path);
    SetIntrinsics(path, SquareMatrix(path, elements), &result.camera);
    result.lens = YamlLens(path, file);
    const cv::FileNode scale = YamlNode(file, {"depth_scale"});
    if (scale.isInt() || scale.isReal()) {
      result.depth_scale = static_cast<double>(scale);
    }
  } catch (const cv::Exception&) {
    FailAsYaml(path);
  }
  return result;
}

}  // namespace

cv::Mat_<double> ReadMatrix(const std::string& path, int rows, int columns) {
  const std::string shape =
      rows > 0 ? std::to_string(rows) + "x" + std::to_string(columns)
               : "3x3 or 4x4";
  cv::Mat_<double> matrix;
  for (const TextLine& line : ReadTextLines(path, /*cut_comments=*/true)) {
    const std::vector<double> numbers = RowOf(line);
    const int most = columns > 0 ? columns : 4;
    const bool fits = static_cast<int>(numbers.size()) <= most &&
                      (matrix.empty() || matrix.cols == int(numbers.size()));
    if (!fits || matrix.rows == 4) line.Refuse("a row of a matrix of " + shape);
    matrix.push_back(cv::Mat(cv::Mat(numbers).t()));
  }
  const bool right = rows > 0 ? matrix.rows == rows && matrix.cols == columns
                              : matrix.rows >= 3 && matrix.cols >= 3;
  if (right) return matrix;
  throw InputError(path + ": a matrix of " + std::to_string(matrix.rows) + "x" +
                   std::to_string(matrix.cols) + ": expected " + shape);
}

void SetIntrinsics(const std::string& place, const cv::Mat_<double>& matrix,
                   PinholeCamera* camera) {
  camera->fx = matrix(0, 0);
  camera->fy = matrix(1, 1);
  camera->cx = matrix(0, 2);
  camera->cy = matrix(1, 2);
  const bool rest = matrix(0, 1) == 0 && matrix(1, 0) == 0 &&
                    matrix(2, 0) == 0 && matrix(2, 1) == 0 && matrix(2, 2) == 1;
  if (rest && camera->fx > 0 && camera->fy > 0) return;
  throw InputError(place + ": '" + RowsText(matrix) +
                   "': expected a matrix of intrinsics, fx 0 cx, 0 fy cy, "
                   "0 0 1, with focal lengths > 0");
}

LensDistortion MakeLensDistortion(const std::string& place,
                                  const std::string& model,
                                  const std::vector<double>& coefficients) {
  LensDistortion lens;
  const bool is_none = std::all_of(coefficients.begin(), coefficients.end(),
                                   [](double c) { return c == 0; });
  if (is_none) return lens;
  const bool known = model == "plumb_bob" || model == "rational_polynomial";
  if (!known || coefficients.size() > lens.coefficients.size()) {
    throw InputError(place + ": distortion '" + model + "' of " +
                     std::to_string(coefficients.size()) +
                     " coefficients: expected plumb_bob or "
                     "rational_polynomial, of 8 at most");
  }
  std::copy(coefficients.begin(), coefficients.end(),
            lens.coefficients.begin());
  return lens;
}

std::optional<Rigid3d> RigidMotion(const std::string& place,
                                   const cv::Mat_<double>& matrix) {
  Rigid3d motion = Rigid3d::Identity();
  Eigen::Matrix3d linear;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) linear(i, j) = matrix(i, j);
    motion.translation()[i] = matrix(i, 3);
  }
  if (!linear.allFinite() || !motion.translation().allFinite()) {
    return std::nullopt;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(
      linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  motion.linear() = svd.matrixU() * svd.matrixV().transpose();
  // Text files have six decimals, or fewer.
  const double off = (motion.linear() - linear).norm();
  if (off < 0.01 && linear.determinant() > 0) return motion;
  throw InputError(place + ": turned by '" + RowsText(matrix) +
                   "': expected a rigid motion, a rotation and a way");
}

Rigid3d KnownRigidMotion(const std::string& place,
                         const cv::Mat_<double>& matrix) {
  const std::optional<Rigid3d> motion = RigidMotion(place, matrix);
  if (motion) return *motion;
  throw InputError(place + ": turned by '" + RowsText(matrix) +
                   "': expected finite numbers, those of a rigid motion");
}

Calibration ReadForeignCalibration(const std::string& path) {
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".json") return ReadJsonCalibration(path);
  if (extension == ".yaml" || extension == ".yml") {
    return ReadYamlCalibration(path);
  }
  Calibration result;
  SetIntrinsics(path, ReadMatrix(path), &result.camera);
  return result;
}

std::optional<Calibration> FindForeignCalibration(const std::string& folder) {
  for (const char* name : kForeignFiles) {
    const fs::path file = fs::path(folder) / name;
    if (fs::exists(file)) return ReadForeignCalibration(file.string());
  }
  return std::nullopt;
}

}  // namespace splitfusion
