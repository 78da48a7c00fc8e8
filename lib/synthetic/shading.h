#ifndef SPLITFUSION_LIB_SYNTHETIC_SHADING_H_
#define SPLITFUSION_LIB_SYNTHETIC_SHADING_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "splitfusion/lib/geometry/camera.h"
#include "splitfusion/lib/geometry/rigid3.h"
#include "splitfusion/lib/synthetic/solid.h"

namespace splitfusion {

/// A surface in one frame.
struct PosedSurface {
  const TexturedMesh* rest = nullptr;     ///< Textures and triangles.
  std::vector<Eigen::Vector3f> vertices;  ///< Camera frame, metres.
  std::vector<Eigen::Vector3f> normals;   ///< Camera frame, unit length.
};

/// A noise-free picture of surfaces.
struct RenderedScene {
  cv::Mat_<cv::Vec3f> color;      ///< HxW BGR, 0..1; grey where nothing is.
  cv::Mat_<float> depth;          ///< HxW z-depth, metres; 0 = nothing.
  cv::Mat_<unsigned char> label;  ///< HxW instance id; 0 = background.
};

/// Renders surfaces with per-pixel textures, two ceiling lights and light from
/// above; no shadows.
RenderedScene RenderSurfaces(const std::vector<PosedSurface>& surfaces,
                             const PinholeCamera& camera,
                             const Rigid3d& world_from_camera);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SYNTHETIC_SHADING_H_
