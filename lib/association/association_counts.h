#ifndef SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_
#define SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_

#include <string>
#include <vector>

namespace splitfusion {

/// What the rejection of a model point tells of where its surface is.
enum class Rejection {
  kUntold,    ///< Nothing: no depth was measured that would tell.
  kOccluded,  ///< Something else is before it.
  kAbsent,    ///< It would be in view and is not there.
  kMisfit,    ///< The surface is there, and does not fit.
};

/// Model points that an association rejected for one reason.
struct RejectedPoints {
  std::string reason;  ///< The association's word for it, a key of reports.
  Rejection kind = Rejection::kUntold;  ///< What it tells.
  int count = 0;                        ///< Model points.
};

/// What became of the model points of one association. Every model point is
/// counted exactly once below `model_points`.
struct AssociationCounts {
  int model_points = 0;  ///< Visible model samples.
  int accepted = 0;      ///< Became correspondences.
  /// The others, by the reasons that the association knows, in its order.
  std::vector<RejectedPoints> rejected;

  /// Rejected ones of a kind.
  int Count(Rejection kind) const {
    int count = 0;
    for (const RejectedPoints& points : rejected) {
      if (points.kind == kind) count += points.count;
    }
    return count;
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ASSOCIATION_ASSOCIATION_COUNTS_H_
