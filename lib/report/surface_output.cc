#include "splitfusion/lib/report/surface_output.h"

#include <filesystem>
#include <system_error>

#include "splitfusion/lib/deformation/graph_file.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

/// The final mesh under the motions of one frame, camera frame; `whole`: with
/// what was seen only later.
TriangleMesh WarpMesh(const SurfaceModel& model, const PartEnds& ends,
                      const std::vector<Skinning>& skinning, int frame,
                      bool whole) {
  DeformationGraph graph = model.graph;
  graph.motions = MotionsOfAll(model.history, graph, ends, frame);
  const WarpField warp(graph);
  TriangleMesh mesh = model.mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    mesh.vertices[i] = warp.WarpPoint(skinning[i], mesh.vertices[i]);
    mesh.normals[i] = warp.WarpNormal(skinning[i], mesh.normals[i]);
  }
  if (whole) graph.first_seen.clear();
  mesh.triangles = SeenTriangles(model.mesh, skinning, graph, frame);
  return mesh;
}

}  // namespace

StretchedArea WriteWarpedMeshes(const RunPaths& paths, int id,
                                const std::string& label,
                                const SurfaceModel& model, int neighbors,
                                const WarpedOutput& warped) {
  StretchedArea cut;
  if (warped.every <= 0) return cut;
  const double stretched_from = StretchedFrom(model.mesh);
  const std::vector<Skinning> skinning =
      SkinningIndex(model.graph, neighbors).Skin(model.mesh.vertices);
  const PartEnds ends = EndsOfParts(model.history, model.graph);
  for (int i = 0; i < model.history.size(); ++i) {
    const int frame = model.history.frame(i);
    if (frame % warped.every != 0) continue;
    TriangleMesh mesh = WarpMesh(model, ends, skinning, frame, warped.whole);
    cut += CutStretched(stretched_from, &mesh);
    WritePly(paths.WarpedMesh(id, label, frame), mesh);
  }
  return cut;
}

StretchedArea WriteSurface(const RunPaths& paths, const Surface& surface,
                           const SurfaceModel& model,
                           const WarpedOutput& warped) {
  const std::string folder = paths.Surface(surface.id(), surface.label());
  std::error_code ignored;  // Files that cannot be written say so.
  std::filesystem::create_directory(std::filesystem::path(folder).parent_path(),
                                    ignored);
  WritePly(folder + "/mesh.ply", model.mesh);
  surface.volume().Write(folder + "/tsdf.vdb");
  const int neighbors = surface.graph_options().neighbors_per_point;
  WriteGraph(folder + "/graph.json", model.graph, neighbors);
  WriteMotions(folder + "/motions.bin", model.history, model.graph.size());
  if (surface.is_ray_cast()) return {};
  return WriteWarpedMeshes(paths, surface.id(), surface.label(), model,
                           neighbors, warped);
}

}  // namespace splitfusion
