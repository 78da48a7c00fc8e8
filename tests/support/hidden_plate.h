#ifndef SPLITFUSION_TESTS_SUPPORT_HIDDEN_PLATE_H_
#define SPLITFUSION_TESTS_SUPPORT_HIDDEN_PLATE_H_

#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// Where a point of a plate is in a frame, in the world, metres.
using PlateMap =
    std::function<Eigen::Vector3d(const Eigen::Vector3d&, int frame)>;

/// Poses of a camera that moves and turns, world from camera.
std::map<int, Rigid3d> Poses(const std::vector<int>& frames);

/// 0 to `last`.
std::vector<int> FramesUpTo(int last);

/// A plate that `map` moves in the world, all of it seen.
SurfaceModel SeenPlate(const std::map<int, Rigid3d>& poses,
                       const PlateMap& map);

/// The plate was in sight in neither of these frames, and stood still in the
/// camera's frame, for the nodes that `is_hidden` tells.
void Hide(int first, int last, const std::function<bool(int)>& is_hidden,
          SurfaceModel* model);

/// Walks along x and sinks.
Eigen::Vector3d Walk(const Eigen::Vector3d& p, int frame);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_HIDDEN_PLATE_H_
