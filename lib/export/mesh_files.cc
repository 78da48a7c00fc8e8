#include "splitfusion/lib/export/mesh_files.h"

#include <cstdint>
#include <cstdio>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"

namespace splitfusion {
namespace {

/// A text by a format of printf, which is many times as fast as a stream.
template <typename... Values>
void Print(std::ostream* out, const char* format, Values... values) {
  char text[128];  // Layout.
  out->write(text, std::snprintf(text, sizeof(text), format, values...));
}

void PrintVertex(const TriangleMesh& mesh, std::size_t i, std::ostream* out) {
  const Eigen::Vector3f& p = mesh.vertices[i];
  Print(out, "v %.6f %.6f %.6f", p.x(), p.y(), p.z());
  if (!mesh.colors.empty()) {
    const auto& color = mesh.colors[i];
    Print(out, " %.4f %.4f %.4f", color[0] / 255.0, color[1] / 255.0,
          color[2] / 255.0);
  }
  *out << '\n';
}

std::string PcdHeader(const TriangleMesh& mesh) {
  std::string fields = "x y z", sizes = "4 4 4", types = "F F F",
              counts = "1 1 1";
  if (!mesh.normals.empty()) {
    fields += " normal_x normal_y normal_z";
    sizes += " 4 4 4";
    types += " F F F";
    counts += " 1 1 1";
  }
  if (!mesh.colors.empty()) {
    fields += " rgb";
    sizes += " 4";
    types += " U";
    counts += " 1";
  }
  const std::string points = std::to_string(mesh.vertices.size());
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " +
         fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nCOUNT " + counts +
         "\nWIDTH " + points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         points + "\nDATA binary\n";
}

}  // namespace

void WriteObj(const std::string& path, const TriangleMesh& mesh) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      PrintVertex(mesh, i, &out);
    }
    for (const Eigen::Vector3f& n : mesh.normals) {
      Print(&out, "vn %.4f %.4f %.4f\n", n.x(), n.y(), n.z());
    }
    const char* format = mesh.normals.empty() ? "f %d %d %d\n"
                                              : "f %1$d//%1$d %2$d//%2$d "
                                                "%3$d//%3$d\n";
    for (const Eigen::Vector3i& t : mesh.triangles) {
      Print(&out, format, t[0] + 1, t[1] + 1, t[2] + 1);
    }
  });
}

void WritePcd(const std::string& path, const TriangleMesh& mesh) {
  WriteFileAtomically(path, [&](std::ostream& out) {
    out << PcdHeader(mesh);
    const auto write = [&](const void* data, std::size_t size) {
      out.write(static_cast<const char*>(data),
                static_cast<std::streamsize>(size));
    };
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      write(mesh.vertices[i].data(), sizeof(Eigen::Vector3f));
      if (!mesh.normals.empty()) {
        write(mesh.normals[i].data(), sizeof(Eigen::Vector3f));
      }
      if (!mesh.colors.empty()) {
        const auto& color = mesh.colors[i];
        const std::uint32_t packed =
            color[0] << 16 | color[1] << 8 | color[2];  // Format.
        write(&packed, sizeof(packed));
      }
    }
  });
}

}  // namespace splitfusion
