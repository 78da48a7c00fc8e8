#include "splitfusion/lib/export/gltf_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
using Points = std::vector<Eigen::Vector3f>;

constexpr int kVertexTarget = 34962;  // Format.
constexpr int kIndexTarget = 34963;   // Format.
constexpr int kSetOfInfluences = 4;   // Format.

std::vector<float> FlatOf(const Points& points) {
  std::vector<float> flat;
  flat.reserve(3 * points.size());
  for (const Eigen::Vector3f& p : points) {
    flat.insert(flat.end(), p.data(), p.data() + 3);
  }
  return flat;
}

/// glTF asks for unit length: a normal that has none points up.
Points UnitNormals(const Points& normals) {
  Points unit;
  unit.reserve(normals.size());
  for (const Eigen::Vector3f& normal : normals) {
    const float length = normal.norm();
    unit.push_back(length > 0 ? Eigen::Vector3f(normal / length)
                              : Eigen::Vector3f::UnitY());
  }
  return unit;
}

/// Of sRGB, 16 bits: 8 are too few for what is dark.
std::uint16_t LinearOf(std::uint8_t value) {
  const double v = value / 255.0;  // Unit.
  const double linear =
      v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);  // Unit.
  return static_cast<std::uint16_t>(std::lround(65535 * linear));
}

/// Red, green, blue and full opacity.
std::vector<std::uint16_t> LinearColors(const TriangleMesh& mesh) {
  std::array<std::uint16_t, 256> linear;
  for (int i = 0; i < 256; ++i) {
    linear[i] = LinearOf(static_cast<std::uint8_t>(i));
  }
  std::vector<std::uint16_t> colors;
  colors.reserve(4 * mesh.colors.size());
  for (const auto& color : mesh.colors) {
    for (const std::uint8_t value : color) colors.push_back(linear[value]);
    colors.push_back(std::numeric_limits<std::uint16_t>::max());
  }
  return colors;
}

std::vector<std::uint32_t> CornersOfTriangles(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      corners.push_back(static_cast<std::uint32_t>(t[k]));
    }
  }
  return corners;
}

Points Differences(const Points& base, const Points& other) {
  Points differences(base.size());
  for (std::size_t i = 0; i < base.size(); ++i) {
    differences[i] = other[i] - base[i];
  }
  return differences;
}

}  // namespace

Json AddPrimitive(const TriangleMesh& mesh, GlbFile* file) {
  const GlbArrayKind bounded = {"VEC3", kVertexTarget, false, true};
  Json attributes;
  attributes["POSITION"] = file->Add(FlatOf(mesh.vertices), bounded);
  if (!mesh.normals.empty()) {
    attributes["NORMAL"] =
        file->Add(FlatOf(UnitNormals(mesh.normals)), {"VEC3", kVertexTarget});
  }
  if (!mesh.colors.empty()) {
    attributes["COLOR_0"] =
        file->Add(LinearColors(mesh), {"VEC4", kVertexTarget, true});
  }
  const int indices =
      file->Add(CornersOfTriangles(mesh), {"SCALAR", kIndexTarget});
  return {{"attributes", attributes}, {"indices", indices}, {"material", 0}};
}

void AddSkinning(const std::vector<Skinning>& skinning, GlbFile* file,
                 Json* primitive) {
  int most = 0;
  for (const Skinning& one : skinning) most = std::max(most, one.count);
  for (int set = 0; set * kSetOfInfluences < most; ++set) {
    std::vector<std::uint16_t> joints;
    std::vector<float> weights;
    for (const Skinning& one : skinning) {
      for (int k = 0; k < kSetOfInfluences; ++k) {
        const int i = set * kSetOfInfluences + k;
        const bool used = i < one.count;
        joints.push_back(used ? static_cast<std::uint16_t>(one.nodes[i])
                              : std::uint16_t{0});
        weights.push_back(used ? one.weights[i] : 0);
      }
    }
    Json& attributes = (*primitive)["attributes"];
    const std::string number = std::to_string(set);
    attributes["JOINTS_" + number] = file->Add(joints, {"VEC4", kVertexTarget});
    attributes["WEIGHTS_" + number] =
        file->Add(weights, {"VEC4", kVertexTarget});
  }
}

void AddSource(const std::vector<int>& source, GlbFile* file, Json* primitive) {
  // glTF has no larger integers for vertices; floats are exact up to 2^24.
  const std::vector<float> indices(source.begin(), source.end());
  (*primitive)["attributes"]["_VERTEX"] =
      file->Add(indices, {"SCALAR", kVertexTarget});
}

void AddTarget(const TriangleMesh& base, const TriangleMesh& mesh,
               GlbFile* file, Json* primitive) {
  const GlbArrayKind bounded = {"VEC3", kVertexTarget, false, true};
  Json target;
  target["POSITION"] =
      file->Add(FlatOf(Differences(base.vertices, mesh.vertices)), bounded);
  if (!base.normals.empty()) {
    const Points differences =
        Differences(UnitNormals(base.normals), UnitNormals(mesh.normals));
    target["NORMAL"] = file->Add(FlatOf(differences), {"VEC3", kVertexTarget});
  }
  (*primitive)["targets"].push_back(target);
}

}  // namespace splitfusion
