#include "splitfusion/lib/evaluation/animated_surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {

AnimatedSurface::AnimatedSurface(RecordedSurface surface)
    : surface_(std::move(surface)),
      index_(surface_.graph, surface_.neighbors_per_point),
      skinnings_(index_.Skin(surface_.mesh.vertices)),
      stretched_from_(StretchedFrom(surface_.mesh)),
      ends_(EndsOfParts(surface_.motions, surface_.graph)) {}

bool AnimatedSurface::HasMotions(int frame) const {
  return surface_.motions.Has(frame);
}

bool AnimatedSurface::Tracked(int frame) const {
  return surface_.motions.Tracked(frame);
}

int AnimatedSurface::FirstFrame() const {
  return surface_.motions.empty() ? -1 : surface_.motions.frame(0);
}

bool AnimatedSurface::BeginsIn(int frame) const {
  const std::vector<ModelPart>& parts = surface_.graph.parts;
  const auto begins = [&](const ModelPart& part) {
    return part.first_frame == frame;
  };
  const auto goes_on = [&](const ModelPart& part) {
    return part.first_frame < frame && frame < part.end_frame;
  };
  return FirstFrame() == frame ||
         (std::any_of(parts.begin(), parts.end(), begins) &&
          std::none_of(parts.begin(), parts.end(), goes_on));
}

bool AnimatedSurface::EndsBetween(int before, int frame) const {
  const std::vector<ModelPart>& parts = surface_.graph.parts;
  return std::any_of(parts.begin(), parts.end(), [&](const ModelPart& part) {
    return before < part.end_frame && part.end_frame <= frame;
  });
}

WarpField AnimatedSurface::WarpAt(int frame) const {
  DeformationGraph graph = surface_.graph;
  graph.motions = MotionsOfAll(surface_.motions, graph, ends_, frame);
  return WarpField(graph);
}

std::vector<Eigen::Vector3f> AnimatedSurface::VerticesAt(int frame) const {
  const WarpField warp = WarpAt(frame);
  std::vector<Eigen::Vector3f> vertices(surface_.mesh.vertices.size());
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t i) {
    vertices[i] = warp.WarpPoint(skinnings_[i], surface_.mesh.vertices[i]);
  });
  return vertices;
}

std::vector<Eigen::Vector3i> AnimatedSurface::TrianglesInUse(int frame) const {
  std::vector<Eigen::Vector3i> triangles;
  for (const Eigen::Vector3i& t : surface_.mesh.triangles) {
    if (surface_.graph.IsInUse(skinnings_[t[0]].nodes[0], frame)) {
      triangles.push_back(t);
    }
  }
  return triangles;
}

TriangleMesh AnimatedSurface::MeshAt(int frame, StretchedArea* stretch) const {
  TriangleMesh mesh;
  mesh.triangles =
      SeenTriangles(surface_.mesh, skinnings_, surface_.graph, frame);
  mesh.vertices = VerticesAt(frame);
  const StretchedArea found = CutStretched(stretched_from_, &mesh);
  if (stretch != nullptr) *stretch = found;
  return mesh;
}

std::vector<AnimatedSurface> AnimateSurfaces(
    std::vector<RecordedSurface> surfaces) {
  return {std::make_move_iterator(surfaces.begin()),
          std::make_move_iterator(surfaces.end())};
}

}  // namespace splitfusion
