#pragma GCC optimize("no-trapping-math")

#include "splitfusion/lib/frame/depth_edges.h"

#include "splitfusion/lib/base/vector_clones.h"

namespace splitfusion {

SPLITFUSION_VECTOR_CLONES
void MarkEdges(const float* depth, int stride, int width, float focal_length,
               const DepthNoise& noise, std::uint8_t* edges) {
  const DepthNoise local = noise;  // Which no edge's address can be that of.
  for (int u = 0; u < width; ++u) {
    const float z = depth[u];
    int is_edge = 0;
    for (int step = 1; step <= kEdgeBorder; ++step) {
      const int offsets[] = {-step, step, -step * stride, step * stride};
      for (const int offset : offsets) {
        const float other = depth[u + offset];
        const float jump =
            EdgeJump(other < z ? other : z, step, focal_length, local);
        is_edge |= (other > 0) & IsDepthJump(z, other, jump);
      }
    }
    edges[u] = is_edge & (z > 0) ? 255 : 0;
  }
}

}  // namespace splitfusion
