#ifndef SPLITFUSION_LIB_TRACKING_RIGID_PARTS_H_
#define SPLITFUSION_LIB_TRACKING_RIGID_PARTS_H_

#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/geometry/depth_noise.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/tracking/point_motion.h"

namespace splitfusion {

/// How rigid parts are looked for among point motions.
struct RigidPartOptions {
  int count = 10;         ///< At most so many parts; 0: none.
  double radius = 0.15;   ///< Of what a part is drawn from, metres.
  double reach = 0.5;     ///< Of a part from where it was drawn, metres.
  double inlier = 0.012;  ///< Distance of its points, less noise, metres.
  int min_points = 12;    ///< Fewer are no part.

  /// Names, ranges and meaning of all fields.
  void List(OptionList* list);
};

/// Points that one rigid motion carries.
struct RigidPart {
  Rigid3d motion;           ///< Carries `from` to `to`.
  std::vector<int> points;  ///< Indices of its point motions, ascending.
};

/// Finds parts that move rigidly among point motions some of which are wrong:
/// sample consensus of rigid motions (Fischler and Bolles 1981; PCL's) within
/// balls, each grown to all points that agree with it within its reach; the
/// part of most points first, then that of most of the others. Seeds are fixed.
///
/// @return at most options.count, by their size; no point is in two.
std::vector<RigidPart> FindRigidParts(const std::vector<PointMotion>& motions,
                                      const DepthNoise& noise,
                                      const RigidPartOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TRACKING_RIGID_PARTS_H_
