#ifndef SPLITFUSION_LIB_PAGE_RUN_SCENE_H_
#define SPLITFUSION_LIB_PAGE_RUN_SCENE_H_

#include <nlohmann/json.hpp>
#include <string>

#include "splitfusion/lib/page/reported_run.h"

namespace splitfusion {

/// What the viewer of a page plays.
struct RunScene {
  /// {"frames", "poses" ([x, y, z, qx, qy, qz, qw] of the camera in the
  /// world, by frame), "fov" (degrees, vertical), "fields", "surfaces"}.
  nlohmann::ordered_json header;
  std::string arrays;  ///< PackedArrays::Text()
};

/// All surfaces of a run as they move, made smaller for a page: of each at most
/// about 30,000 vertices that its triangles still need when the least important
/// edges are collapsed, places in steps of 0.04 mm, rotations in 1/10000
/// of a quaternion's entries; every n-th frame where there are more than two
/// million motions of nodes. `source` of a surface are the indices that its
/// vertices have in mesh.ply.
///
/// @throw InputError if a file of the run is missing or broken.
RunScene SceneOfRun(const ReportedRun& run);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_RUN_SCENE_H_
