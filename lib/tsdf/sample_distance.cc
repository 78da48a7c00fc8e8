#include "splitfusion/lib/tsdf/sample_distance.h"

#include "splitfusion/lib/tsdf/internal/grids.h"
#include "splitfusion/lib/tsdf/trilinear.h"

namespace splitfusion {
namespace {

/// Distance of one voxel; null if it was never observed.
const float* ObservedDistance(const TsdfVolume::Grids& grids, int x, int y,
                              int z) {
  constexpr int kLast = internal::kLeafSize - 1;
  const int number = grids.table.Find(x >> 3, y >> 3, z >> 3);
  if (number == 0) return nullptr;
  const internal::LeafBuffers& leaf = grids.leaves[number - 1];
  const int offset = (x & kLast) << 6 | (y & kLast) << 3 | (z & kLast);
  return leaf.weight[offset] > 0 ? leaf.distance + offset : nullptr;
}

}  // namespace

std::optional<DistanceSample> SampleDistance(const TsdfVolume& volume,
                                             const Eigen::Vector3d& point) {
  constexpr double kFarthest = 1e8;  // Maths: voxels that an int can count.
  const double voxel = volume.options().voxel_size;
  const Eigen::Vector3d place = point / voxel;
  if (!(place.cwiseAbs().maxCoeff() < kFarthest)) return std::nullopt;
  const Eigen::Vector3d low = place.array().floor();
  const Eigen::Vector3i at = low.cast<int>();
  float corners[2][2][2];
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 2; ++y) {
      for (int z = 0; z < 2; ++z) {
        const float* distance = ObservedDistance(volume.grids(), at.x() + x,
                                                 at.y() + y, at.z() + z);
        if (distance == nullptr) return std::nullopt;
        corners[x][y][z] = *distance;
      }
    }
  }
  const TrilinearSample sample =
      MixTrilinear(corners, (place - low).cast<float>());
  return DistanceSample{sample.value, sample.gradient.cast<double>() / voxel};
}

}  // namespace splitfusion
