#include "splitfusion/lib/report/surface_output.h"

#include <filesystem>
#include <system_error>

#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

/// The final mesh under the motions of one frame, camera frame; `whole`: with
/// what was seen only later.
TriangleMesh WarpMesh(const Surface& surface, const FrameMotions& motions,
                      bool whole) {
  DeformationGraph graph = surface.graph();
  graph.motions = motions.motions;
  const WarpField warp(graph);
  TriangleMesh mesh = surface.mesh();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Skinning& skinning = surface.mesh_skinning()[i];
    mesh.vertices[i] = warp.WarpPoint(skinning, mesh.vertices[i]);
    mesh.normals[i] = warp.WarpNormal(skinning, mesh.normals[i]);
  }
  if (!whole) {
    mesh.triangles = SeenTriangles(surface.mesh(), surface.mesh_skinning(),
                                   surface.graph(), motions.frame);
  }
  return mesh;
}

}  // namespace

void WriteSurface(const RunPaths& paths, const Surface& surface,
                  const WarpedOutput& warped) {
  const std::string folder = paths.Surface(surface.id(), surface.label());
  std::error_code ignored;  // Files that cannot be written say so.
  std::filesystem::create_directory(std::filesystem::path(folder).parent_path(),
                                    ignored);
  WritePly(folder + "/mesh.ply", surface.mesh());
  surface.volume().Write(folder + "/tsdf.vdb");
  WriteGraph(folder + "/graph.json", surface.graph(),
             surface.graph_options().neighbors_per_point);
  WriteMotions(folder + "/motions.bin", surface.history());
  if (surface.is_ray_cast() || warped.every <= 0) return;
  for (const FrameMotions& motions : surface.history().frames) {
    if (motions.frame % warped.every != 0) continue;
    WritePly(paths.WarpedMesh(surface.id(), surface.label(), motions.frame),
             WarpMesh(surface, motions, warped.whole));
  }
}

}  // namespace splitfusion
