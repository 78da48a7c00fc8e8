#ifndef SPLITFUSION_LIB_EVALUATION_ANIMATED_SURFACE_H_
#define SPLITFUSION_LIB_EVALUATION_ANIMATED_SURFACE_H_

#include <string>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/evaluation/recorded_run.h"
#include "splitfusion/lib/geometry/stretched_area.h"

namespace splitfusion {

/// A recorded surface that can be carried to every frame of its life.
class AnimatedSurface {
 public:
  /// Keeps the surface and computes the skinning of its mesh.
  explicit AnimatedSurface(RecordedSurface surface);

  /// The surface as the run left it.
  const RecordedSurface& recorded() const { return surface_; }
  /// Whether this is the background.
  bool background() const { return surface_.id == 0; }

  /// Whether the surface has motions for a frame.
  bool HasMotions(int frame) const;
  /// Whether it has, and they were tracked, not carried over.
  bool Tracked(int frame) const;
  /// First frame with motions; -1 if there is none.
  int FirstFrame() const;
  /// Whether it, or a new model of it, begins in a frame: no part of what was
  /// there before goes on.
  bool BeginsIn(int frame) const;
  /// Whether a part of its model is in use in `frame` no more, but still was
  /// in `before`.
  bool EndsBetween(int before, int frame) const;

  /// Warp into the camera frame of a frame that has motions.
  WarpField WarpAt(int frame) const;

  /// Vertices of the mesh in the camera frame of a frame that has motions,
  /// metres.
  std::vector<Eigen::Vector3f> VerticesAt(int frame) const;

  /// Triangles of the parts of the model that are in use in a frame, also what
  /// was seen only later.
  std::vector<Eigen::Vector3i> TrianglesInUse(int frame) const;

  /// The mesh as warped/FRAME.ply has it: what had been seen by then
  /// (SeenTriangles), without triangles that are stretched; no normals, no
  /// colours. `stretch`, if given: what there was before these were cut.
  TriangleMesh MeshAt(int frame, StretchedArea* stretch = nullptr) const;

  /// Skinning of a canonical point, metres.
  Skinning Skin(const Eigen::Vector3f& point) const {
    return index_.Skin(point);
  }

 private:
  RecordedSurface surface_;
  SkinningIndex index_;
  std::vector<Skinning> skinnings_;  // Of the vertices.
  double stretched_from_;            // Metres.
  PartEnds ends_;
};

/// All surfaces of a run, by id.
std::vector<AnimatedSurface> AnimateSurfaces(
    std::vector<RecordedSurface> surfaces);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_ANIMATED_SURFACE_H_
