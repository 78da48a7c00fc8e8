#ifndef SPLITFUSION_TOOLS_BENCHMARK_GROWTH_VOLUMES_H_
#define SPLITFUSION_TOOLS_BENCHMARK_GROWTH_VOLUMES_H_

#include "splitfusion/lib/model/surface.h"

namespace splitfusion {

/// Options at another voxel size; the truncation has as many voxels as before.
SurfaceOptions WithVoxels(SurfaceOptions options, double voxel_size);

/// Memory of all grids of a volume, as OpenVDB counts it.
double VolumeBytes(const TsdfVolume& volume);

}  // namespace splitfusion

#endif  // SPLITFUSION_TOOLS_BENCHMARK_GROWTH_VOLUMES_H_
