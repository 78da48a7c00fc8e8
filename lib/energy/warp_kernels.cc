#include "splitfusion/lib/energy/warp_kernels.h"

#include <algorithm>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/energy/internal/wide_vectors.h"

namespace splitfusion {

// Row `i` of a 3x3 matrix by columns times the vector x, y, z.
#define SPLITFUSION_ROW_TIMES(m, i, x, y, z) \
  ((m)[i] * (x) + (m)[(i) + 3] * (y) + (m)[(i) + 6] * (z))

SPLITFUSION_VECTOR_CLONES
void WarpChunk(const PointChunk& chunk, double* warped, double* carried) {
  for (int i = 0; i < chunk.count; i += 4, warped += 12) {
    const double* v = chunk.points + i;
    const Vector4 vx = SPLITFUSION_LOAD4(v);
    const Vector4 vy = SPLITFUSION_LOAD4(v + chunk.stride);
    const Vector4 vz = SPLITFUSION_LOAD4(v + 2 * chunk.stride);
    Vector4 x = {0, 0, 0, 0}, y = x, z = x;
    double* out = carried + i;
    for (int k = 0; k < chunk.node_count; ++k) {
      const TwistedNode& node = *chunk.nodes[k];
      const Vector4 qx = vx - node.rest[0];
      const Vector4 qy = vy - node.rest[1];
      const Vector4 qz = vz - node.rest[2];
      const Vector4 px = SPLITFUSION_ROW_TIMES(node.rotation, 0, qx, qy, qz);
      const Vector4 py = SPLITFUSION_ROW_TIMES(node.rotation, 1, qx, qy, qz);
      const Vector4 pz = SPLITFUSION_ROW_TIMES(node.rotation, 2, qx, qy, qz);
      const Vector4 w = SPLITFUSION_LOAD4(chunk.weights + k * chunk.stride + i);
      x += w * (px + node.offset[0]);
      y += w * (py + node.offset[1]);
      z += w * (pz + node.offset[2]);
      for (const Vector4& p : {px, py, pz}) {
        *reinterpret_cast<Vector4*>(out) = p;
        out += kWarpedChunk;
      }
    }
    for (int lane = 0; lane < 4; ++lane) {
      warped[3 * lane] = x[lane];
      warped[3 * lane + 1] = y[lane];
      warped[3 * lane + 2] = z[lane];
    }
  }
}

SPLITFUSION_VECTOR_CLONES
void DifferentiateChunk(const PointChunk& chunk, const double* carried,
                        int dims, const double* by_point, double* rows) {
  const int columns = 6 * chunk.node_count;
  for (int d = 0; d < dims; ++d) {
    for (int i = 0; i < chunk.count; i += 4) {
      const double* b = by_point + 3 * (dims * i + d);
      const int step = 3 * dims;
      const Vector4 bx = {b[0], b[step], b[2 * step], b[3 * step]};
      const Vector4 by = {b[1], b[step + 1], b[2 * step + 1], b[3 * step + 1]};
      const Vector4 bz = {b[2], b[step + 2], b[2 * step + 2], b[3 * step + 2]};
      const int lanes = std::min(4, chunk.count - i);
      for (int k = 0; k < chunk.node_count; ++k) {
        const double* p = carried + CarriedSize(k) + i;
        const Vector4 px = SPLITFUSION_LOAD4(p);
        const Vector4 py = SPLITFUSION_LOAD4(p + kWarpedChunk);
        const Vector4 pz = SPLITFUSION_LOAD4(p + 2 * kWarpedChunk);
        const Vector4 w =
            SPLITFUSION_LOAD4(chunk.weights + k * chunk.stride + i);
        const Vector4 tx = w * bx, ty = w * by, tz = w * bz;
        const Vector4 cx = py * tz - pz * ty;
        const Vector4 cy = pz * tx - px * tz;
        const Vector4 cz = px * ty - py * tx;
        const double* spin = chunk.nodes[k]->spin_transposed;
        const Vector4 ox = SPLITFUSION_ROW_TIMES(spin, 0, cx, cy, cz);
        const Vector4 oy = SPLITFUSION_ROW_TIMES(spin, 1, cx, cy, cz);
        const Vector4 oz = SPLITFUSION_ROW_TIMES(spin, 2, cx, cy, cz);
        // From six vectors over the points to six numbers a point.
        const Vector4 a = SPLITFUSION_EVEN(ox, oy), c = SPLITFUSION_ODD(ox, oy);
        const Vector4 e = SPLITFUSION_EVEN(oz, tx), f = SPLITFUSION_ODD(oz, tx);
        const Vector4 g = SPLITFUSION_EVEN(ty, tz), h = SPLITFUSION_ODD(ty, tz);
        const Vector4 first[4] = {
            SPLITFUSION_LOWS(a, e), SPLITFUSION_LOWS(c, f),
            SPLITFUSION_HIGHS(a, e), SPLITFUSION_HIGHS(c, f)};
        const Vector2 last[4] = {SPLITFUSION_LOW(g), SPLITFUSION_LOW(h),
                                 SPLITFUSION_HIGH(g), SPLITFUSION_HIGH(h)};
        double* out = rows + (dims * i + d) * columns + 6 * k;
        for (int lane = 0; lane < lanes; ++lane, out += dims * columns) {
          *reinterpret_cast<Vector4*>(out) = first[lane];
          *reinterpret_cast<Vector2*>(out + 4) = last[lane];
        }
      }
    }
  }
}

}  // namespace splitfusion
