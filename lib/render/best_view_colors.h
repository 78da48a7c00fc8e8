#ifndef SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_
#define SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/model/surface_model.h"

namespace splitfusion {

/// Colours of a surface's vertices from the frames that show them well, once
/// their motions are known. Fusion averages colours in voxels, under the
/// motions that a frame had when it came in: two pairs of eyes. Here every
/// frame counts for a vertex by how well it shows it, the product of
///
///   - pixels per area of the surface, cos(angle) / z^2,
///   - sharpness, 1 / (1 + s / 2): s is the vertex' way in the image since the
///     frame before, pixels, for half of which the shutter is taken to be open,
///   - fit, exp(-(d / sigma)^2 / 2) of its distance d from the live depth,
///     across the surface, with that depth's noise sigma.
///
/// A frame shows a vertex if its nearest node was seen in it
/// (FrameMotions::seen), it faces the camera and lies on live depth, not beside
/// an edge. To favour the best views more than that, by powers of the product,
/// gains no sharpness, and they agree less with the others (docs/ablation.md).
/// Not in the paper; compare Maier et al. 2015, Waechter et al. 2014.
class BestViewColors {
 public:
  /// Of the vertices of `model`, which must outlive this and has its final
  /// motions; `neighbors_per_point`: K of Eq. 3.
  BestViewColors(const SurfaceModel& model, int neighbors_per_point);

  /// The frames in order; one of which the surface has no motion changes
  /// nothing. Needs camera, depth, edges and colour of `live`.
  void Add(int frame, const LiveView& live);

  /// Red, green, blue by vertex; those that no frame showed keep theirs.
  std::vector<std::array<std::uint8_t, 3>> Colors() const;

 private:
  /// What is known of a vertex.
  struct Vertex {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // Weighted, RGB.
    float weight = 0;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // In the last frame.
  };

  const SurfaceModel& model_;
  std::vector<Skinning> skinning_;
  std::vector<Vertex> vertices_;
  int last_frame_ = -1;  // Of Vertex::pixel; -1: none.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_
