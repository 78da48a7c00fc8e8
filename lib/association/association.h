#ifndef SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_H_
#define SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "splitfusion/lib/association/association_counts.h"
#include "splitfusion/lib/association/association_gates.h"
#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/base/registry.h"
#include "splitfusion/lib/frame/live_view.h"

namespace splitfusion {

/// Result of one association.
struct Association {
  std::vector<Correspondence> correspondences;  ///< In order of the samples.
  /// What became of every sample.
  AssociationCounts counts;
  /// Of what the correspondences leave over on both sides: live points of the
  /// surface that no sample was found for, and samples that would be in view
  /// but are not where the model has them. A part that moved farther than the
  /// gates is both. None if gates.lost_distance is 0, or if the association
  /// does not know what is hidden.
  std::vector<Correspondence> lost = {};
};

/// Finds the pairs of model and live points of one surface in one frame (set
/// Omega of SplitFusion Eq. 5), again in every round of tracking.
class Associator {
 public:
  virtual ~Associator() = default;

  /// Pairs the samples under the current warp with live points. `stride`: only
  /// samples rendered at every stride-th row and column of the full image are
  /// used. Every sample that is rejected is counted under its reason. Does not
  /// depend on the number of threads.
  virtual Association Associate(const std::vector<ModelSample>& samples,
                                const WarpField& warp, int stride,
                                const AssociationGates& gates) const = 0;
};

/// Associations by name, made for a live frame, which outlives them, and the id
/// of the surface whose live pixels count.
using AssociationRegistry =
    Registry<Associator, const LiveView&, std::uint16_t>;

/// projective and closest_point.
AssociationRegistry BuiltinAssociations();

/// Projects every warped sample into the live image and takes the live point of
/// that pixel.
std::unique_ptr<Associator> MakeProjectiveAssociator(const LiveView& live,
                                                     std::uint16_t surface);

/// Takes for every warped sample the live point of the surface that is nearest
/// in space, wherever it projects to: the closest point of Besl and McKay
/// (1992). What is hidden shows by its distance alone.
std::unique_ptr<Associator> MakeClosestPointAssociator(const LiveView& live,
                                                       std::uint16_t surface);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_H_
