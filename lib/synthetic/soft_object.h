#ifndef SPLITFUSION_LIB_SYNTHETIC_SOFT_OBJECT_H_
#define SPLITFUSION_LIB_SYNTHETIC_SOFT_OBJECT_H_

#include <Eigen/Core>
#include <vector>

#include "splitfusion/lib/synthetic/solid.h"

namespace splitfusion {

/// A soft toy of 0.45 m that sits and bends, twists and squashes without
/// bones: its axis is a circular arc of changing curvature and direction.
class SoftObject {
 public:
  /// Stands with its foot on `base` (world, metres), facing -y. Textures depend
  /// on the seed.
  SoftObject(const Eigen::Vector3f& base, std::uint32_t seed);

  /// Rest pose, standing on z = 0, facing x.
  const TexturedMesh& rest() const { return rest_; }

  /// Vertices in the world at `time` seconds, in the order of the rest mesh.
  std::vector<Eigen::Vector3f> Vertices(double time) const;

 private:
  Eigen::Vector3f base_;
  TexturedMesh rest_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SOFT_OBJECT_H_
