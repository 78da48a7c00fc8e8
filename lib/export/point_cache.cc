#include "splitfusion/lib/export/point_cache.h"

#include <cstdint>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/export/mesh_files.h"

namespace splitfusion {
namespace {

template <typename T>
void WriteValue(const T& value, std::ostream* out) {
  out->write(reinterpret_cast<const char*>(&value), sizeof(value));
}

void WriteCache(const std::string& path, const ExportSurface& surface) {
  constexpr char kMagic[] = "POINTCACHE2";  // With the zero at its end.
  const std::vector<ExportMoment>& moments = surface.moments;
  const std::size_t first = moments.front().place;
  const std::size_t samples = moments.back().place - first + 1;
  WriteFileAtomically(path, [&](std::ostream& out) {
    out.write(kMagic, sizeof(kMagic));
    WriteValue(std::int32_t{1}, &out);  // Version.
    WriteValue(static_cast<std::int32_t>(surface.mesh.vertices.size()), &out);
    WriteValue(static_cast<float>(first), &out);
    WriteValue(1.0f, &out);  // Frames of the export a sample.
    WriteValue(static_cast<std::int32_t>(samples), &out);
    std::size_t next = 0;
    std::vector<Eigen::Vector3f> points;
    for (std::size_t place = first; place < first + samples; ++place) {
      if (moments[next].place == place) {
        points = surface.VerticesAt(moments[next++], surface.skinning);
      }
      out.write(
          reinterpret_cast<const char*>(points.data()),
          static_cast<std::streamsize>(points.size() * sizeof(points[0])));
    }
  });
}

}  // namespace

std::vector<std::string> WritePointCaches(const std::string& stem,
                                          const ExportScene& scene) {
  std::vector<std::string> files;
  for (const ExportSurface& surface : scene.surfaces) {
    const std::string path = stem + "_" + surface.name;
    WriteObj(path + ".obj", surface.At(surface.moments.front()));
    files.push_back(path + ".obj");
    if (surface.IsStill(scene.frames.size())) continue;
    WriteCache(path + ".pc2", surface);
    files.push_back(path + ".pc2");
  }
  return files;
}

}  // namespace splitfusion
