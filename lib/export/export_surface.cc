#include "splitfusion/lib/export/export_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstdint>
#include <utility>

#include "splitfusion/lib/geometry/stretched_area.h"

namespace splitfusion {
namespace {

WarpField WarpOf(const ExportSurface& surface, const ExportMoment& moment) {
  DeformationGraph graph;
  graph.positions = surface.graph.positions;
  graph.motions = moment.motions;
  return WarpField(graph);
}

/// Leaves those of `values` that are `kept`; an empty list stays empty.
template <typename Values>
void Keep(const std::vector<std::uint8_t>& kept, Values* values) {
  if (values->empty()) return;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] != 0) (*values)[count++] = (*values)[i];
  }
  values->resize(count);
}

}  // namespace

bool ExportSurface::IsStill(std::size_t frames) const {
  constexpr double kTolerance = 1e-5;  // Metres and radians.
  if (moments.size() != frames) return false;
  const std::vector<NodeMotion>& first = moments.front().motions;
  return std::all_of(
      moments.begin(), moments.end(), [&](const ExportMoment& moment) {
        for (std::size_t i = 0; i < first.size(); ++i) {
          const NodeMotion& motion = moment.motions[i];
          if (!motion.rotation.isApprox(first[i].rotation, kTolerance) ||
              (motion.translation - first[i].translation).norm() > kTolerance) {
            return false;
          }
        }
        return true;
      });
}

TriangleMesh ExportSurface::At(const ExportMoment& moment) const {
  TriangleMesh warped = mesh;
  const WarpField warp = WarpOf(*this, moment);
  tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t i) {
    warped.vertices[i] = warp.WarpPoint(skinning[i], mesh.vertices[i]);
    if (mesh.normals.empty()) return;
    warped.normals[i] = warp.WarpNormal(skinning[i], mesh.normals[i]);
  });
  return warped;
}

std::vector<Eigen::Vector3f> ExportSurface::VerticesAt(
    const ExportMoment& moment, const std::vector<Skinning>& by) const {
  std::vector<Eigen::Vector3f> warped(mesh.vertices.size());
  const WarpField warp = WarpOf(*this, moment);
  tbb::parallel_for(std::size_t{0}, warped.size(), [&](std::size_t i) {
    warped[i] = warp.WarpPoint(by[i], mesh.vertices[i]);
  });
  return warped;
}

void LeaveStretchedOut(ExportSurface* surface) {
  if (surface->graph.rigid()) return;
  const double from = StretchedFrom(surface->mesh);
  const std::size_t before = surface->mesh.triangles.size();
  for (const ExportMoment& moment : surface->moments) {
    TriangleMesh warped;
    warped.vertices = surface->VerticesAt(moment, surface->skinning);
    warped.triangles = std::move(surface->mesh.triangles);
    CutStretched(from, &warped);
    surface->mesh.triangles = std::move(warped.triangles);
  }
  surface->stretched_triangles =
      static_cast<int>(before - surface->mesh.triangles.size());
}

void LeaveUnusedOut(ExportSurface* surface) {
  TriangleMesh& mesh = surface->mesh;
  std::vector<std::uint8_t> used(mesh.vertices.size(), 0);
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  }
  std::vector<int> place(used.size(), 0);
  for (std::size_t i = 1; i < used.size(); ++i) {
    place[i] = place[i - 1] + used[i - 1];
  }
  for (Eigen::Vector3i& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) t[k] = place[t[k]];
  }
  Keep(used, &mesh.vertices);
  Keep(used, &mesh.normals);
  Keep(used, &mesh.colors);
  Keep(used, &surface->source);
  Keep(used, &surface->skinning);
}

}  // namespace splitfusion
