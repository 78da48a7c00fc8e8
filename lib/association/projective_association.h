#ifndef SPLITFUSION_LIB_ASSOCIATION_PROJECTIVE_ASSOCIATION_H_
#define SPLITFUSION_LIB_ASSOCIATION_PROJECTIVE_ASSOCIATION_H_

#include <cstdint>
#include <vector>

#include "splitfusion/lib/association/association_counts.h"
#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// When a model point and a live point are taken for the same.
struct AssociationGates {
  double distance = 0.10;       ///< Metres; grows with the depth noise.
  double normal_angle = 0.52;   ///< Radians between the normals.
  double grazing_angle = 1.31;  ///< Radians between live normal and view ray.
  bool coarse_color = false;    ///< Compare colours at the coarse level.
};

/// Result of one association.
struct Association {
  std::vector<Correspondence> correspondences;  ///< In order of the samples.
  /// What became of every sample.
  AssociationCounts counts;
};

/// Projects every warped model sample into the live image and takes the live
/// point of that pixel (set Omega of SplitFusion Eq. 5). `stride`: only samples
/// rendered at every stride-th row and column of the full image are used;
/// `surface` is the id whose live pixels count. Every rejection is counted.
Association Associate(const std::vector<ModelSample>& samples,
                      const WarpField& warp, const LiveView& live,
                      std::uint16_t surface, int stride,
                      const AssociationGates& gates);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_PROJECTIVE_ASSOCIATION_H_
