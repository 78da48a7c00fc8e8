#ifndef SPLITFUSION_LIB_GEOMETRY_TYPICAL_POINTS_H_
#define SPLITFUSION_LIB_GEOMETRY_TYPICAL_POINTS_H_

#include <Eigen/Core>
#include <vector>

namespace splitfusion {

/// Four points, columns, with the mean and the covariance of many: an affine
/// motion moves them as far in the mean square.
using TypicalPoints = Eigen::Matrix<double, 3, 4>;

/// Those of `points`; zero if there are none.
TypicalPoints TypicalPointsOf(const std::vector<Eigen::Vector3f>& points);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_GEOMETRY_TYPICAL_POINTS_H_
