#ifndef SPLITFUSION_LIB_TSDF_TRILINEAR_H_
#define SPLITFUSION_LIB_TSDF_TRILINEAR_H_

#include <Eigen/Core>

namespace splitfusion {

/// Value and derivative between eight voxels.
struct TrilinearSample {
  float value = 0;  ///< In units of the voxels' values.
  /// By the three coordinates, per voxel.
  Eigen::Vector3f gradient = Eigen::Vector3f::Zero();
};

/// Mixes the values of the eight corners of a cube, by x, y and z, at the place
/// `f` in it, 0..1 along every axis.
inline TrilinearSample MixTrilinear(const float corners[2][2][2],
                                    const Eigen::Vector3f& f) {
  const auto mix = [](float a, float b, float w) { return a + w * (b - a); };
  float by_x[2], slab[2][2], dz[2];
  for (int x = 0; x < 2; ++x) {
    for (int y = 0; y < 2; ++y) {
      slab[x][y] = mix(corners[x][y][0], corners[x][y][1], f.z());
    }
    by_x[x] = mix(slab[x][0], slab[x][1], f.y());
    dz[x] = mix(corners[x][0][1] - corners[x][0][0],
                corners[x][1][1] - corners[x][1][0], f.y());
  }
  TrilinearSample sample;
  sample.value = mix(by_x[0], by_x[1], f.x());
  sample.gradient.x() = by_x[1] - by_x[0];
  sample.gradient.y() =
      mix(slab[0][1] - slab[0][0], slab[1][1] - slab[1][0], f.x());
  sample.gradient.z() = mix(dz[0], dz[1], f.x());
  return sample;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_TSDF_TRILINEAR_H_
