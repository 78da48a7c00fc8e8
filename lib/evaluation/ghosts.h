#ifndef SPLITFUSION_LIB_EVALUATION_GHOSTS_H_
#define SPLITFUSION_LIB_EVALUATION_GHOSTS_H_

#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Background that is nowhere near anything that never moves.
struct Ghosts {
  int vertices = 0;  ///< Of the background's mesh.
  int far = 0;       ///< Farther than kGhostDistance from the truth.

  /// `far` / `vertices`; 0 without vertices.
  double Share() const {
    return vertices > 0 ? static_cast<double>(far) / vertices : 0;
  }
};

/// From the static scene, metres.
constexpr double kGhostDistance = 0.05;

/// Counts the vertices of a background, put into the true world, that are
/// farther than kGhostDistance from the true static scene: people and things
/// that were fused into it and never removed.
Ghosts CountGhosts(const TriangleMesh& background,
                   const TriangleMesh& static_truth);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_GHOSTS_H_
