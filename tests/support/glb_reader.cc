#include "support/glb_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

namespace splitfusion {
namespace {

using Json = nlohmann::json;

std::uint32_t NumberAt(const std::string& bytes, std::size_t at) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

template <typename T>
double ValueAs(const char* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return static_cast<double>(value);
}

double ValueAt(const char* at, int component_type) {
  if (component_type == 5123) return ValueAs<std::uint16_t>(at);
  if (component_type == 5125) return ValueAs<std::uint32_t>(at);
  EXPECT_EQ(component_type, 5126);
  return ValueAs<float>(at);
}

int ComponentBytes(int component_type) {
  return component_type == 5123 ? 2 : 4;
}

int ComponentsOf(const Json& accessor) {
  const std::string type = accessor["type"];
  return type == "MAT4" ? 16 : type == "SCALAR" ? 1 : type.back() - '0';
}

double ToSrgb(double linear) {
  return 255 * (linear <= 0.0031308
                    ? 12.92 * linear
                    : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

std::vector<Eigen::Vector3d> Rows(const std::vector<double>& flat,
                                  int columns = 3) {
  std::vector<Eigen::Vector3d> rows;
  for (std::size_t i = 0; i < flat.size(); i += columns) {
    rows.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  }
  return rows;
}

}  // namespace

GlbReader::GlbReader(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_GT(file.size(), 28u) << path;
  if (file.size() <= 28) return;
  EXPECT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(NumberAt(file, 4), 2u);
  EXPECT_EQ(NumberAt(file, 8), file.size());
  const std::uint32_t size = NumberAt(file, 12);
  EXPECT_EQ(file.substr(16, 4), "JSON");
  EXPECT_EQ(size % 4, 0u);
  json_ = Json::parse(file.substr(20, size));
  EXPECT_EQ(NumberAt(file, 20 + size), file.size() - 28 - size);
  EXPECT_EQ(file.substr(24 + size, 4), std::string("BIN\0", 4));
  bytes_ = file.substr(28 + size);
  parents_.assign(json_["nodes"].size(), -1);
  for (std::size_t i = 0; i < parents_.size(); ++i) {
    for (const int child : json_["nodes"][i].value("children", Json::array())) {
      parents_.at(child) = static_cast<int>(i);
    }
  }
  CheckAccessors();
}

void GlbReader::CheckAccessors() const {
  EXPECT_EQ(json_["buffers"][0]["byteLength"], bytes_.size());
  for (const Json& accessor : json_["accessors"]) {
    const Json& view =
        json_["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
    const auto length = view["byteLength"].get<std::size_t>();
    EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
    EXPECT_LE(view["byteOffset"].get<std::size_t>() + length, bytes_.size());
    EXPECT_EQ(accessor["count"].get<std::size_t>() * ComponentsOf(accessor) *
                  ComponentBytes(accessor["componentType"]),
              length);
  }
  for (const Json& mesh : json_.value("meshes", Json::array())) {
    const Json& primitive = mesh["primitives"][0];
    const int positions = primitive["attributes"]["POSITION"];
    const Json& accessor = json_["accessors"][positions];
    EXPECT_EQ(accessor["min"].size(), 3u);
    const std::vector<double> corners = Array(primitive["indices"]);
    EXPECT_LT(*std::max_element(corners.begin(), corners.end()),
              accessor["count"].get<double>());
  }
}

std::vector<double> GlbReader::Array(int index) const {
  const Json& accessor = json_["accessors"].at(index);
  const Json& view =
      json_["bufferViews"].at(accessor["bufferView"].get<std::size_t>());
  const int type = accessor["componentType"];
  const bool normalized = accessor.value("normalized", false);
  const std::size_t count =
      accessor["count"].get<std::size_t>() * ComponentsOf(accessor);
  const char* at = bytes_.data() + view["byteOffset"].get<std::size_t>();
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i, at += ComponentBytes(type)) {
    values.push_back(ValueAt(at, type) / (normalized ? 65535 : 1));
  }
  return values;
}

int GlbReader::Node(const std::string& name) const {
  for (std::size_t i = 0; i < json_["nodes"].size(); ++i) {
    if (json_["nodes"][i]["name"] == name) return static_cast<int>(i);
  }
  return -1;
}

std::vector<double> GlbReader::Animated(int node, const std::string& path,
                                        double time) const {
  if (!json_.contains("animations")) return {};
  const Json& animation = json_["animations"][0];
  for (const Json& channel : animation["channels"]) {
    if (channel["target"]["node"] != node ||
        channel["target"]["path"] != path) {
      continue;
    }
    const Json& sampler =
        animation["samplers"].at(channel["sampler"].get<std::size_t>());
    const std::vector<double> times = Array(sampler["input"]);
    const std::vector<double> values = Array(sampler["output"]);
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
    // The last key that is not later; tests ask for times of keys alone.
    const auto later =
        std::upper_bound(times.begin(), times.end(), time + 1e-5);
    const std::size_t key =
        later == times.begin() ? 0 : later - times.begin() - 1;
    const std::size_t size = values.size() / times.size();
    return {values.begin() + key * size, values.begin() + (key + 1) * size};
  }
  return {};
}

Eigen::Matrix4d GlbReader::LocalAt(int node, double time) const {
  const Json& object = json_["nodes"].at(node);
  const auto value = [&](const char* path, std::vector<double> rest) {
    const std::vector<double> animated = Animated(node, path, time);
    if (!animated.empty()) return animated;
    return object.contains(path) ? object[path].get<std::vector<double>>()
                                 : rest;
  };
  const auto t = value("translation", {0, 0, 0});
  const auto r = value("rotation", {0, 0, 0, 1});
  const auto s = value("scale", {1, 1, 1});
  const Eigen::Quaterniond turn(r[3], r[0], r[1], r[2]);
  EXPECT_NEAR(turn.norm(), 1, 1e-5);
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  local.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  local.rotate(turn);
  local.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  return local.matrix();
}

Eigen::Matrix4d GlbReader::MatrixAt(int node, double time) const {
  const Eigen::Matrix4d local = LocalAt(node, time);
  return parents_.at(node) < 0 ? local : MatrixAt(parents_[node], time) * local;
}

const Json& GlbReader::Primitive(int node) const {
  const int mesh = json_["nodes"].at(node)["mesh"];
  return json_["meshes"].at(mesh)["primitives"].at(0);
}

std::vector<double> GlbReader::MorphedAt(int node, const std::string& attribute,
                                         double time) const {
  const Json& primitive = Primitive(node);
  std::vector<double> values = Array(primitive["attributes"][attribute]);
  const std::vector<double> weights = Animated(node, "weights", time);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0) continue;
    const auto target = Array(primitive["targets"].at(i)[attribute]);
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] += weights[i] * target[k];
    }
  }
  return values;
}

std::vector<Eigen::Matrix4d> GlbReader::SkinningAt(int node,
                                                   double time) const {
  const Json& primitive = Primitive(node);
  const std::size_t vertices =
      json_["accessors"][primitive["attributes"]["POSITION"].get<int>()]
           ["count"];
  const Json& object = json_["nodes"][node];
  if (!object.contains("skin")) {
    return std::vector<Eigen::Matrix4d>(vertices, MatrixAt(node, time));
  }
  const Json& skin = json_["skins"].at(object["skin"].get<std::size_t>());
  const std::vector<double> binds = Array(skin["inverseBindMatrices"]);
  std::vector<Eigen::Matrix4d> moved;
  for (const int joint : skin["joints"]) {
    const Eigen::Map<const Eigen::Matrix4d> bind(&binds[16 * moved.size()]);
    moved.push_back(MatrixAt(joint, time) * bind);
  }
  std::vector<Eigen::Matrix4d> blended(vertices, Eigen::Matrix4d::Zero());
  std::vector<double> sums(vertices, 0);
  for (int set = 0; set < 2; ++set) {
    const std::string number = std::to_string(set);
    if (!primitive["attributes"].contains("JOINTS_" + number)) continue;
    const auto joints = Array(primitive["attributes"]["JOINTS_" + number]);
    const auto weights = Array(primitive["attributes"]["WEIGHTS_" + number]);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      blended[i / 4] += weights[i] * moved.at(static_cast<int>(joints[i]));
      sums[i / 4] += weights[i];
    }
  }
  for (const double sum : sums) EXPECT_NEAR(sum, 1, 1e-6);
  return blended;
}

std::vector<Eigen::Vector3d> GlbReader::VerticesAt(int node,
                                                   double time) const {
  std::vector<Eigen::Vector3d> vertices =
      Rows(MorphedAt(node, "POSITION", time));
  const std::vector<Eigen::Matrix4d> moved = SkinningAt(node, time);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i] = (moved[i] * vertices[i].homogeneous()).head<3>();
  }
  return vertices;
}

std::vector<Eigen::Vector3d> GlbReader::NormalsAt(int node, double time) const {
  std::vector<Eigen::Vector3d> normals = Rows(MorphedAt(node, "NORMAL", time));
  const std::vector<Eigen::Matrix4d> moved = SkinningAt(node, time);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    normals[i] = (moved[i].topLeftCorner<3, 3>() * normals[i]).normalized();
  }
  return normals;
}

std::vector<Eigen::Vector3d> GlbReader::Colors(int node) const {
  std::vector<Eigen::Vector3d> colors =
      Rows(Array(Primitive(node)["attributes"]["COLOR_0"]), 4);
  for (Eigen::Vector3d& color : colors) color = color.unaryExpr(&ToSrgb);
  return colors;
}

std::vector<double> GlbReader::Source(int node) const {
  return Array(Primitive(node)["attributes"]["_VERTEX"]);
}

std::vector<double> GlbReader::Indices(int node) const {
  return Array(Primitive(node)["indices"]);
}

}  // namespace splitfusion
