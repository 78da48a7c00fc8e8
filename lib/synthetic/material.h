#ifndef SPLITFUSION_LIB_SYNTHETIC_MATERIAL_H_
#define SPLITFUSION_LIB_SYNTHETIC_MATERIAL_H_

#include <Eigen/Core>
#include <cstdint>

namespace splitfusion {

/// Shape of a procedural solid texture.
enum class Pattern {
  kMottled,  ///< Soft blotches between the two colours (carpet, skin, plaster).
  kChecker,  ///< Cubes of alternating colour (tiles, patchwork).
  kStripes,  ///< Horizontal bands.
  kPlaid,    ///< Crossing bands with a thin line (shirt).
  kWood,     ///< Grain along x.
  kPosters,  ///< Random coloured patches (pictures, books).
};

/// A solid texture: the colour of a point depends on its place in the rest
/// pose, so that it sticks to a deforming surface.
struct Material {
  Pattern pattern = Pattern::kMottled;       ///< What it looks like.
  Eigen::Vector3f first{0.5f, 0.5f, 0.5f};   ///< Red, green, blue, 0..1.
  Eigen::Vector3f second{0.6f, 0.6f, 0.6f};  ///< Red, green, blue, 0..1.
  float period = 0.1f;                       ///< Size of the pattern, metres.
  std::uint32_t seed = 0;                    ///< Of its random parts.
};

/// Colour (red, green, blue, 0..1, before lighting) at a point of the rest
/// pose, metres.
Eigen::Vector3f MaterialColor(const Material& material,
                              const Eigen::Vector3f& rest_point);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_MATERIAL_H_
