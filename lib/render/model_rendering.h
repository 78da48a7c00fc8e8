#ifndef SPLITFUSION_LIB_RENDER_MODEL_RENDERING_H_
#define SPLITFUSION_LIB_RENDER_MODEL_RENDERING_H_

#include <map>
#include <memory>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/model/surface.h"
#include "splitfusion/lib/render/model_map.h"
#include "splitfusion/lib/render/rasterizer.h"
#include "splitfusion/lib/render/ray_caster.h"
#include "splitfusion/lib/split/surface_prediction.h"

namespace splitfusion {

/// Surfaces by id, the background first.
using SurfaceMap = std::map<int, std::unique_ptr<Surface>>;

/// See MeshRendering::alone.
constexpr int kAloneStride = 4;

/// All surfaces that are drawn from their meshes, warped and rasterised
/// together, so that they hide one another.
struct MeshRendering {
  /// Camera of the rendering.
  PinholeCamera camera;
  /// Nearest triangle of every pixel.
  Raster raster;
  /// Camera frame; of a plane fitted to the rendered depth, which averages the
  /// noise of a young model that the TSDF's gradient still has.
  cv::Mat_<cv::Vec3f> normals;
  std::map<int, int> first_triangle;  ///< Surface id -> its first index.
  /// Surface id -> its depth if no other surface hid it, at every
  /// kAloneStride-th pixel of the rendering; metres, 0 = nothing.
  std::map<int, cv::Mat_<float>> alone;
};

/// Renders the meshes under the current motions.
MeshRendering RenderMeshes(const SurfaceMap& surfaces,
                           const PinholeCamera& camera);

/// Whether every surface that is drawn from its mesh, and not inactive, is in
/// the rendering.
bool AllDrawn(const SurfaceMap& surfaces, const MeshRendering& rendering);

/// Renders one surface as if no other hid it.
MeshRendering RenderAlone(const Surface& surface, const PinholeCamera& camera);

/// The rigid background, ray-cast under its current motion for every
/// `stride`-th pixel of `camera`; empty if there is none.
ModelMap RenderBackground(const SurfaceMap& surfaces,
                          const PinholeCamera& camera, int stride,
                          const RayCastOptions& options);

/// Surface id and depth of every pixel of a rendering, the background (may be
/// empty) behind it, resized to `full`; the pose is left as it is.
SurfacePrediction ToPrediction(const MeshRendering& rendering,
                               const ModelMap& background,
                               const PinholeCamera& full);

/// The visible points of one surface in a rendering of the full image's every
/// `stride`-th pixel, with their skinning.
std::vector<ModelSample> VisibleSamples(const MeshRendering& rendering,
                                        const Surface& surface, int stride);

/// The visible points of the rigid background in its ray cast for every
/// `stride`-th pixel; `camera_from_canonical` is the motion it was cast under.
std::vector<ModelSample> BackgroundSamples(const ModelMap& cast,
                                           const Rigid3d& camera_from_canonical,
                                           int stride);

/// All surfaces re-united in the camera frame (SplitFusion IV-D): what the
/// camera sees of the model, and the surface id of every pixel.
struct SceneRendering {
  /// Points, normals and colour, camera frame.
  ModelMap map;
  /// Surface id of every pixel, 0 = background or nothing.
  LabelImage labels;
};

/// Renders the whole scene under the current motions.
SceneRendering RenderScene(const SurfaceMap& surfaces,
                           const PinholeCamera& camera,
                           const RayCastOptions& options);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_MODEL_RENDERING_H_
