#include "splitfusion/lib/export/mesh_sequence.h"

#include "splitfusion/lib/export/mesh_files.h"
#include "splitfusion/lib/report/run_paths.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

/// `path`: without extension.
void WriteAs(const std::string& path, const TriangleMesh& mesh,
             MeshFileKind kind) {
  switch (kind) {
    case MeshFileKind::kPly:
      return WritePly(path + ".ply", mesh);
    case MeshFileKind::kObj:
      return WriteObj(path + ".obj", mesh);
    case MeshFileKind::kPcd:
      return WritePcd(path + ".pcd", mesh);
  }
}

}  // namespace

int WriteMeshSequence(const std::string& folder, const ExportScene& scene,
                      MeshFileKind kind, bool grow) {
  int files = 0;
  for (const ExportSurface& surface : scene.surfaces) {
    const bool still = surface.IsStill(scene.frames.size());
    for (const ExportMoment& moment : surface.moments) {
      if (still && moment.place > 0) break;
      TriangleMesh mesh = surface.At(moment);
      if (grow) {
        mesh.triangles = SeenTriangles(surface.mesh, surface.skinning,
                                       surface.graph, moment.frame);
      }
      WriteAs(
          folder + "/" + surface.name + "/" + RunPaths::FrameName(moment.frame),
          mesh, kind);
      ++files;
    }
  }
  return files;
}

}  // namespace splitfusion
