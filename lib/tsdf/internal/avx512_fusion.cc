#pragma GCC optimize("no-trapping-math", "fp-contract=off")

#include "splitfusion/lib/tsdf/internal/rigid_fusion.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)

#include <immintrin.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/geometry/depth_noise.h"

// What has been included is for any processor, what follows for these alone:
// no function of it is called from elsewhere.
#pragma GCC push_options
#pragma GCC target("arch=x86-64-v4")
// Of the compiler's own header: GCC bug 105593.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wuninitialized"

#include "splitfusion/lib/tsdf/internal/avx512_lanes.h"
#include "splitfusion/lib/tsdf/internal/fuse_block.h"

namespace splitfusion {
namespace internal {
namespace {

void Fuse(const FusionView& view, const float steps[3][3], RigidBlock* blocks,
          int count) {
  const FusionView local = view;  // Which no voxel's address can be that of.
  FuseRigid<SixteenLanes>(local, steps, blocks, count);
}

}  // namespace
}  // namespace internal
}  // namespace splitfusion

#pragma GCC pop_options

namespace splitfusion {
namespace internal {

RigidFusion Avx512Fusion() {
  return __builtin_cpu_supports("x86-64-v4") ? Fuse : nullptr;
}

}  // namespace internal
}  // namespace splitfusion

#else

namespace splitfusion {
namespace internal {

RigidFusion Avx512Fusion() { return nullptr; }

}  // namespace internal
}  // namespace splitfusion

#endif
