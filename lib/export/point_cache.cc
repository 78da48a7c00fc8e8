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

void WriteCache(const PointCacheFiles& files, const ExportSurface& surface) {
  constexpr char kMagic[] = "POINTCACHE2";  // With the zero at its end.
  const std::vector<ExportMoment>& moments = surface.moments;
  WriteFileAtomically(files.cache, [&](std::ostream& out) {
    out.write(kMagic, sizeof(kMagic));
    WriteValue(std::int32_t{1}, &out);  // Version.
    WriteValue(static_cast<std::int32_t>(surface.mesh.vertices.size()), &out);
    WriteValue(static_cast<float>(files.start), &out);
    WriteValue(1.0f, &out);  // Frames of the export a sample.
    WriteValue(static_cast<std::int32_t>(files.frames), &out);
    std::size_t next = 0;
    std::vector<Eigen::Vector3f> points;
    for (std::size_t i = 0; i < files.frames; ++i) {
      if (moments[next].place == files.start + i) {
        points = surface.VerticesAt(moments[next++], surface.skinning);
      }
      out.write(
          reinterpret_cast<const char*>(points.data()),
          static_cast<std::streamsize>(points.size() * sizeof(points[0])));
    }
  });
}

}  // namespace

std::vector<PointCacheFiles> WritePointCaches(const std::string& stem,
                                              const ExportScene& scene) {
  std::vector<PointCacheFiles> written;
  for (ExportSurface surface : scene.surfaces) {
    // Blender's import of OBJ leaves them out, and takes no cache that has
    // them.
    LeaveUnusedOut(&surface);
    if (surface.mesh.vertices.empty()) continue;
    const std::string path = stem + "_" + surface.name;
    const std::size_t first = surface.moments.front().place;
    const std::size_t last = surface.moments.back().place;
    PointCacheFiles files{path + ".obj", "", first, last - first + 1};
    WriteObj(files.mesh, surface.At(surface.moments.front()));
    if (!surface.IsStill(scene.frames.size())) {
      files.cache = path + ".pc2";
      WriteCache(files, surface);
    }
    written.push_back(files);
  }
  return written;
}

}  // namespace splitfusion
