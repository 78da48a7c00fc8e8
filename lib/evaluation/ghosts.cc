#include "splitfusion/lib/evaluation/ghosts.h"

#include <algorithm>
#include <vector>

#include "splitfusion/lib/evaluation/surface_error.h"

namespace splitfusion {

Ghosts CountGhosts(const TriangleMesh& background,
                   const TriangleMesh& static_truth) {
  const std::vector<double> distances =
      DistancesToSurface(background.vertices, static_truth, 2 * kGhostDistance);
  Ghosts ghosts;
  ghosts.vertices = static_cast<int>(distances.size());
  ghosts.far = static_cast<int>(
      std::count_if(distances.begin(), distances.end(),
                    [](double d) { return d > kGhostDistance; }));
  return ghosts;
}

}  // namespace splitfusion
