#ifndef SPLITFUSION_LIB_EXPORT_EXPORT_SURFACE_H_
#define SPLITFUSION_LIB_EXPORT_EXPORT_SURFACE_H_

#include <cstddef>
#include <string>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Motions of the nodes of a surface in one frame of an export.
struct ExportMoment {
  std::size_t place = 0;            ///< Index among the frames of the export.
  int frame = 0;                    ///< Frame index of the run.
  bool tracked = true;              ///< False: carried on.
  std::vector<NodeMotion> motions;  ///< Space of the export from canonical.
};

/// A mesh that moves, with the same vertices and triangles in all frames: a
/// surface of a run, or one of its models.
struct ExportSurface {
  std::string name;   ///< NNN_LABEL, with a suffix if it is a part of one.
  int id = 0;         ///< Of the surface.
  std::string label;  ///< Class name, as in the name of its folder.
  TriangleMesh mesh;  ///< Canonical frame, metres; triangles to show.
  /// Of every vertex its index in mesh.ply.
  std::vector<int> source;
  /// Nodes, edges, and when they were seen first; without parts and motions.
  DeformationGraph graph;
  std::vector<Skinning> skinning;     ///< Eq. 3, of every vertex.
  std::vector<ExportMoment> moments;  ///< Frames in which it is there.
  /// Triangles that are left out as they are stretched in some frame.
  int stretched_triangles = 0;

  /// Whether it has the same motion in all its frames and is in all `frames` of
  /// the export: to within rounding of the run's files.
  bool IsStill(std::size_t frames) const;

  /// The mesh in a frame, space of the export: warped by Eq. 2.
  TriangleMesh At(const ExportMoment& moment) const;

  /// The same of a skinning other than its own, vertices alone.
  std::vector<Eigen::Vector3f> VerticesAt(
      const ExportMoment& moment, const std::vector<Skinning>& by) const;
};

/// Takes those triangles out of a surface that are stretched in any of its
/// frames (CutStretched()); counts them.
void LeaveStretchedOut(ExportSurface* surface);

/// Takes those vertices out of a surface that no triangle uses; the others stay
/// in their order.
void LeaveUnusedOut(ExportSurface* surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPORT_EXPORT_SURFACE_H_
