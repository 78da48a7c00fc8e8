#include "splitfusion/lib/geometry/triangle_mesh.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/quoted.h"

namespace splitfusion {
namespace {

struct PlyProperty {
  std::string name;
  std::string type;
  std::string list_type;  // Type of the count; empty for a scalar.
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool binary = false;
  std::vector<PlyElement> elements;
};

template <typename T>
double ReadAs(std::istream& stream) {
  T value;
  stream.read(reinterpret_cast<char*>(&value), sizeof(T));
  return static_cast<double>(value);
}

class PlyReader {
 public:
  explicit PlyReader(const std::string& path)
      : path_(path), stream_(path, std::ios::binary) {
    std::error_code error;
    bytes_ = std::filesystem::file_size(path, error);
    if (error || !stream_) throw InputError(path + ": cannot be opened");
    ReadHeader();
  }

  const std::vector<PlyElement>& elements() const { return header_.elements; }

  double ReadScalar(const std::string& type) {
    double value = 0;
    if (!header_.binary) {
      stream_ >> value;
    } else if (type == "float" || type == "float32") {
      value = ReadAs<float>(stream_);
    } else if (type == "double" || type == "float64") {
      value = ReadAs<double>(stream_);
    } else if (type == "uchar" || type == "uint8") {
      value = ReadAs<std::uint8_t>(stream_);
    } else if (type == "char" || type == "int8") {
      value = ReadAs<std::int8_t>(stream_);
    } else if (type == "ushort" || type == "uint16") {
      value = ReadAs<std::uint16_t>(stream_);
    } else if (type == "short" || type == "int16") {
      value = ReadAs<std::int16_t>(stream_);
    } else if (type == "uint" || type == "uint32") {
      value = ReadAs<std::uint32_t>(stream_);
    } else if (type == "int" || type == "int32") {
      value = ReadAs<std::int32_t>(stream_);
    } else {
      Fail("property type " + Quoted(type) + " is unknown");
    }
    if (!stream_) Fail("file ends before its last element");
    return value;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(path_ + ": not a readable PLY (" + what + ")");
  }

 private:
  void ReadHeader() {
    std::string line;
    std::getline(stream_, line);
    if (line.rfind("ply", 0) != 0) Fail("first line is not 'ply'");
    bool ended = false;
    while (!ended && std::getline(stream_, line)) {
      if (!line.empty() && line.back() == '\r') line.pop_back();
      ended = ParseHeaderLine(line);
    }
    if (!ended) Fail("no 'end_header'");
  }

  bool ParseHeaderLine(const std::string& line) {
    std::istringstream words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "format") {
      std::string format;
      words >> format;
      if (format == "binary_big_endian") Fail("big-endian format");
      header_.binary = format == "binary_little_endian";
    } else if (keyword == "element") {
      PlyElement element;
      std::int64_t count = -1;
      if (!(words >> element.name >> count) || count < 0) {
        Fail("bad line: " + Quoted(line));
      }
      // Each takes a byte at least; checked before memory is taken for them.
      element.count = static_cast<std::size_t>(count);
      if (element.count > bytes_) Fail("file ends before its last element");
      header_.elements.push_back(element);
    } else if (keyword == "property") {
      PlyProperty property;
      words >> property.type;
      if (property.type == "list") words >> property.list_type >> property.type;
      if (!(words >> property.name) || header_.elements.empty()) {
        Fail("bad line: " + Quoted(line));
      }
      header_.elements.back().properties.push_back(property);
    }
    return keyword == "end_header";
  }

  std::string path_;
  std::ifstream stream_;
  std::uintmax_t bytes_ = 0;
  PlyHeader header_;
};

void StoreVertexProperty(const std::string& name, double value,
                         std::size_t index, TriangleMesh* mesh,
                         PlyProperties* extra) {
  const auto resized = [index](auto* values) -> auto& {
    if (values->size() <= index) values->resize(index + 1);
    return (*values)[index];
  };
  static const std::map<std::string, int> kAxis = {
      {"x", 0}, {"y", 1}, {"z", 2}};
  static const std::map<std::string, int> kNormalAxis = {
      {"nx", 0}, {"ny", 1}, {"nz", 2}};
  static const std::map<std::string, int> kChannel = {
      {"red", 0}, {"green", 1}, {"blue", 2}};
  if (const auto axis = kAxis.find(name); axis != kAxis.end()) {
    mesh->vertices[index][axis->second] = static_cast<float>(value);
  } else if (const auto axis = kNormalAxis.find(name);
             axis != kNormalAxis.end()) {
    resized(&mesh->normals)[axis->second] = static_cast<float>(value);
  } else if (const auto channel = kChannel.find(name);
             channel != kChannel.end()) {
    resized(&mesh->colors)[channel->second] = static_cast<std::uint8_t>(value);
  } else if (extra != nullptr) {
    (*extra)[name].push_back(value);
  }
}

void ReadVertices(const PlyElement& element, PlyReader* reader,
                  TriangleMesh* mesh, PlyProperties* extra) {
  mesh->vertices.assign(element.count, Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (!property.list_type.empty()) reader->Fail("list in a vertex");
      StoreVertexProperty(property.name, reader->ReadScalar(property.type), i,
                          mesh, extra);
    }
  }
}

void ReadOtherElement(const PlyElement& element, PlyReader* reader,
                      TriangleMesh* mesh) {
  const auto vertex_count = static_cast<double>(mesh->vertices.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (property.list_type.empty()) {
        reader->ReadScalar(property.type);
        continue;
      }
      const double count = reader->ReadScalar(property.list_type);
      std::vector<int> indices;
      for (int k = 0; k < count; ++k) {
        const double index = reader->ReadScalar(property.type);
        if (element.name == "face" && !(index >= 0 && index < vertex_count)) {
          reader->Fail("vertex index " + std::to_string(index) +
                       " out of range");
        }
        indices.push_back(static_cast<int>(index));
      }
      if (element.name != "face" || property.name.rfind("vertex_ind", 0) != 0) {
        continue;
      }
      for (std::size_t k = 2; k < indices.size(); ++k) {
        mesh->triangles.emplace_back(indices[0], indices[k - 1], indices[k]);
      }
    }
  }
}

template <typename T>
void Append(const T* values, int count, std::vector<char>* bytes) {
  const auto* begin = reinterpret_cast<const char*>(values);
  bytes->insert(bytes->end(), begin, begin + sizeof(T) * count);
}

}  // namespace

std::vector<Eigen::Vector3f> ComputeVertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(),
                                       Eigen::Vector3f::Zero());
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]];
    const Eigen::Vector3f area_normal =
        (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
    for (int k = 0; k < 3; ++k) normals[t[k]] += area_normal;
  }
  for (Eigen::Vector3f& normal : normals) {
    const float length = normal.norm();
    if (length > 0) normal /= length;
  }
  return normals;
}

void WritePly(const std::string& path, const TriangleMesh& mesh,
              const PlyProperties& extra) {
  for (const auto& [name, values] : extra) {
    CheckOption(values.size() == mesh.vertices.size(),
                path + ": values of '" + name + "'", values.size(),
                std::to_string(mesh.vertices.size()) + ", one a vertex");
  }
  const bool with_normals = !mesh.normals.empty();
  const bool with_colors = !mesh.colors.empty();
  std::vector<char> bytes;
  bytes.reserve(mesh.vertices.size() * 27 + mesh.triangles.size() * 13);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Append(mesh.vertices[i].data(), 3, &bytes);
    if (with_normals) Append(mesh.normals[i].data(), 3, &bytes);
    if (with_colors) Append(mesh.colors[i].data(), 3, &bytes);
    for (const auto& property : extra) {
      const auto value = static_cast<float>(property.second[i]);
      Append(&value, 1, &bytes);
    }
  }
  const std::uint8_t corners = 3;  // Format.
  for (const Eigen::Vector3i& triangle : mesh.triangles) {
    Append(&corners, 1, &bytes);
    Append(triangle.data(), 3, &bytes);
  }
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << "ply\nformat binary_little_endian 1.0\nelement vertex "
        << mesh.vertices.size()
        << "\nproperty float x\nproperty float y\nproperty float z\n";
    if (with_normals) {
      out << "property float nx\nproperty float ny\nproperty float nz\n";
    }
    if (with_colors) {
      out << "property uchar red\nproperty uchar green\n"
             "property uchar blue\n";
    }
    for (const auto& property : extra) {
      out << "property float " << property.first << '\n';
    }
    out << "element face " << mesh.triangles.size()
        << "\nproperty list uchar int vertex_indices\nend_header\n";
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
}

TriangleMesh ReadPly(const std::string& path, PlyProperties* extra) {
  PlyReader reader(path);
  TriangleMesh mesh;
  for (const PlyElement& element : reader.elements()) {
    if (element.name == "vertex") {
      ReadVertices(element, &reader, &mesh, extra);
    } else {
      ReadOtherElement(element, &reader, &mesh);
    }
  }
  return mesh;
}

}  // namespace splitfusion
