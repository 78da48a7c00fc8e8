#ifndef SPLITFUSION_LIB_MODEL_CANONICAL_PLACES_H_
#define SPLITFUSION_LIB_MODEL_CANONICAL_PLACES_H_

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// How much of a surface's model there is at a live point of the surface.
enum class Coverage : std::uint8_t {
  kNone,        ///< Not a point of the surface, or not a certain one.
  kModelled,    ///< The mesh is there.
  kCarried,     ///< No mesh yet, but a node that can carry it.
  kOutOfReach,  ///< Too far from every node to belong to the graph.
};

/// Where the live points of a non-rigid surface belong in its canonical frame.
///
/// Each has one place there: that of the nearest point of the warped mesh, or,
/// where there is none, that to which the nearest node carries it back (Eq. 1
/// inverted). A warp field is not injective: parts that are astray may lie
/// upon others. To fuse a live point wherever the warp happens to reach it
/// would copy the one onto the other, and the copy would be tracked from then
/// on (the voxel collisions of Dou et al., Fusion4D, 2016).
///
/// What was confirmed comes first: a live point that a confirmed vertex is near
/// to belongs there, however near another one is. A limb that tracking had lost
/// is modelled anew; where the old one is found again, the new one, which lies
/// upon it, is shown by no live point from then on.
///
/// Blocks of 2x2 pixels share the place of their first certain point.
struct CanonicalPlaces {
  cv::Mat_<cv::Vec3f> points;       ///< Metres; NaN where there is none.
  cv::Mat_<std::uint8_t> coverage;  ///< Coverage of every pixel.
  /// Vertices that live points were found to be at, ascending.
  std::vector<int> shown;
};

/// A surface's mesh, on which live points are looked for.
struct PlacedMesh {
  const std::vector<Eigen::Vector3f>& vertices;  ///< Canonical, metres.
  const std::vector<Eigen::Vector3f>& warped;    ///< Camera frame, metres.
  /// Of every vertex whether it is confirmed.
  const std::vector<char>& confirmed;
};

/// Distances that tell one Coverage from the other, metres.
struct CoverageLimits {
  double mesh = 0;   ///< A modelled point has a vertex as near as this.
  double reach = 0;  ///< Of a node.
};

/// Finds the places of the live pixels of `surface`.
CanonicalPlaces FindCanonicalPlaces(const LiveView& live, int surface,
                                    const DeformationGraph& graph,
                                    const PlacedMesh& mesh,
                                    const CoverageLimits& limits);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_MODEL_CANONICAL_PLACES_H_
