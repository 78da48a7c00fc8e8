#include "volumes.h"

#include "splitfusion/lib/tsdf/internal/grids.h"

namespace splitfusion {

SurfaceOptions WithVoxels(SurfaceOptions options, double voxel_size) {
  const double voxels = options.tsdf.truncation / options.tsdf.voxel_size;
  options.tsdf.voxel_size = voxel_size;
  options.tsdf.truncation = voxels * voxel_size;
  return options;
}

double VolumeBytes(const TsdfVolume& volume) {
  const TsdfVolume::Grids& grids = volume.grids();
  std::size_t bytes = grids.distance->memUsage() + grids.weight->memUsage();
  if (grids.color) bytes += grids.color->memUsage();
  return static_cast<double>(bytes);
}

}  // namespace splitfusion
