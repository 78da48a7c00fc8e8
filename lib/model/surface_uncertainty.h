#ifndef SPLITFUSION_LIB_MODEL_SURFACE_UNCERTAINTY_H_
#define SPLITFUSION_LIB_MODEL_SURFACE_UNCERTAINTY_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "splitfusion/lib/energy/solution_recorder.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"
#include "splitfusion/lib/model/surface.h"

namespace splitfusion {

/// A surface in one frame, and how well the solve of that frame holds it.
struct SurfaceUncertainty {
  TriangleMesh mesh;  ///< Camera frame, metres; without normals.
  /// Of every vertex, camera frame, square metres; see NodeCovariance.
  std::vector<Eigen::Matrix3d> covariances;
  int nodes = 0;          ///< Of the solve.
  int held_by_prior = 0;  ///< Nodes that no data touch.

  /// Root mean square of a vertex' three standard deviations,
  /// sqrt(trace(covariance) / 3), metres.
  std::vector<double> Sigmas() const;
};

/// The mesh of a surface under its current motions, which `solved` has found,
/// with the covariance of every vertex. What the frame has added to the mesh
/// hangs on the nodes of the solve.
SurfaceUncertainty EstimateUncertainty(const Surface& surface,
                                       const SolvedProblem& solved);

/// Writes the mesh as PLY with the properties `sigma` (Sigmas()), `sigma_x`,
/// `sigma_y` and `sigma_z` (standard deviations along the axes of the camera)
/// and `weakest_x`, `weakest_y` and `weakest_z` (the direction in which it is
/// known least, as long as its deviation along it) of every vertex, metres.
///
/// @throw InputError if the file cannot be written.
void WriteUncertainty(const std::string& path,
                      const SurfaceUncertainty& uncertainty);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_SURFACE_UNCERTAINTY_H_
