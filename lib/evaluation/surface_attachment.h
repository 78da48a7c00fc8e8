#ifndef SPLITFUSION_LIB_EVALUATION_SURFACE_ATTACHMENT_H_
#define SPLITFUSION_LIB_EVALUATION_SURFACE_ATTACHMENT_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/evaluation/animated_surface.h"
#include "splitfusion/lib/geometry/triangle_tree.h"

namespace splitfusion {

/// How far points may be from the surface they are attached to, metres.
constexpr double kAttachmentDistance = 0.10;
/// A surface other than the background that is this near goes first, metres.
constexpr double kForegroundDistance = 0.03;

/// A point tied to a surface.
struct Attachment {
  const AnimatedSurface* surface = nullptr;  ///< Not owned.
  Eigen::Vector3f canonical;  ///< Nearest point of the surface, canonical.
  Skinning skinning;          ///< Of `canonical`.
  Eigen::Vector3d offset;     ///< From there to the point, in the local frame
                              ///< of the warp at the surface point, metres.

  /// Where the warp of a frame carries the point, camera frame, metres. The
  /// offset turns with the surface. The surface must have motions there.
  Eigen::Vector3d PositionAt(const WarpField& warp) const;
};

/// Attaches points to the surfaces as they lie in one frame.
class SurfaceAttacher {
 public:
  /// Takes the surfaces (not owned; each must have motions for `frame`) as they
  /// lie in `frame`, those triangles that face the camera.
  SurfaceAttacher(const std::vector<const AnimatedSurface*>& surfaces,
                  int frame);

  /// Attaches a point (camera frame, metres) to the nearest point of the
  /// surface with id `preferred_id` if that is not 0 and near enough, else of a
  /// surface other than the background if near enough, else of any.
  std::optional<Attachment> Attach(const Eigen::Vector3d& point,
                                   int preferred_id) const;

 private:
  struct Candidate {
    const AnimatedSurface* surface;
    WarpField warp;
    std::vector<Eigen::Vector3i> triangles;  // Those that face the camera.
    TriangleTree tree;
  };

  static Attachment Tie(const Candidate& candidate, const SurfacePoint& nearest,
                        const Eigen::Vector3d& point);

  std::vector<Candidate> candidates_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_SURFACE_ATTACHMENT_H_
