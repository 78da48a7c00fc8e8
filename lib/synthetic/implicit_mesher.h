#ifndef SPLITFUSION_LIB_SYNTHETIC_IMPLICIT_MESHER_H_
#define SPLITFUSION_LIB_SYNTHETIC_IMPLICIT_MESHER_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// A capsule whose radius changes linearly along its axis: one limb.
struct RoundCone {
  Eigen::Vector3f start{0, 0, 0};  ///< Metres.
  Eigen::Vector3f end{0, 0, 0};    ///< Metres.
  float start_radius = 0;          ///< Metres.
  float end_radius = 0;            ///< Metres.
  int bone = 0;                    ///< What carries it; free for the caller.
};

/// Signed distance (metres, negative inside, exact for a capsule) of a point to
/// one cone.
float SignedDistance(const RoundCone& cone, const Eigen::Vector3f& point);

/// Bone of the cone that is nearest to a point; `cones` must not be empty.
int NearestBone(const std::vector<RoundCone>& cones,
                const Eigen::Vector3f& point);

/// Meshes the smooth union of cones as one closed surface.
///
/// `blend`: width of the fillet where two cones meet, metres. `voxel`: size of
/// the sampling grid and thereby of the triangles, metres. Vertices are moved
/// onto the exact surface; normals are filled in.
TriangleMesh MeshRoundCones(const std::vector<RoundCone>& cones, float blend,
                            float voxel);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_IMPLICIT_MESHER_H_
