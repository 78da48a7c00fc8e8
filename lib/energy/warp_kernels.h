#ifndef SPLITFUSION_LIB_ENERGY_WARP_KERNELS_H_
#define SPLITFUSION_LIB_ENERGY_WARP_KERNELS_H_

namespace splitfusion {

// The inner loops of warped points, four points at a time. Free of Eigen and
// compiled for wide vectors as well, see block_kernels.h.

/// A node's motion under the increment of its twist: a canonical point v goes
/// to p + offset with p = rotation (v - rest). Matrices by columns.
struct TwistedNode {
  double rotation[9];  ///< exp(omega) R_i
  double rest[3];      ///< g_i, canonical, metres.
  double offset[3];    ///< g_i + t_i + tau_i, camera frame, metres.
  /// J^T of the left Jacobian J: dp = (J domega) x p, so that of any function
  /// with the derivative b by its point, that by omega is J^T (p x b).
  double spin_transposed[9];
};

/// Points that are warped at a time.
constexpr int kWarpedChunk = 32;  // Speed.

/// Points with common nodes. All arrays may be read three numbers too far.
struct PointChunk {
  const TwistedNode* const* nodes;  ///< Of all points.
  int node_count;                   ///< Number of nodes.
  int count;                        ///< Number of points, up to kWarpedChunk.
  int stride;                       ///< From x to y, from weight to weight.
  const double* points;             ///< All x, all y, all z; canonical, metres.
  const double* weights;            ///< w_k of all points, by node k.
};

/// Numbers of the p_k of a chunk: coordinate by coordinate, by node.
constexpr int CarriedSize(int nodes) { return 3 * kWarpedChunk * nodes; }

/// x = sum_k w_k [ p_k + offset_k ] of every point to `warped` (three a point,
/// room for kWarpedChunk), p_k to `carried`.
void WarpChunk(const PointChunk& chunk, double* warped, double* carried);

/// Derivatives by the nodes' twists of residuals with the derivatives
/// `by_point` by x, to `rows`: 6 numbers a node, `dims` rows a point.
/// `by_point` has three numbers a row and room for kWarpedChunk points.
void DifferentiateChunk(const PointChunk& chunk, const double* carried,
                        int dims, const double* by_point, double* rows);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_WARP_KERNELS_H_
