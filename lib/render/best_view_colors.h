#ifndef SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_
#define SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "splitfusion/lib/deformation/skinning.h"
#include "splitfusion/lib/frame/live_view.h"
#include "splitfusion/lib/model/surface_model.h"
#include "splitfusion/lib/render/rasterizer.h"

namespace splitfusion {

/// Colours of a surface's vertices from the frames that show them well, once
/// their motions are known. Fusion averages colours in voxels, under the
/// motions that a frame had when it came in, so that an eye may be there twice.
/// Here every frame counts for a vertex by how well it shows it, the product of
///
///   - pixels per area of the surface, cos(angle) / z^2,
///   - sharpness, 1 / (1 + s / 2): s is the vertex' way in the image since the
///     frame before, pixels, for half of which the shutter is taken to be open;
///     1 in the surface's first frame,
///   - fit, exp(-(d / sigma)^2 / 2) of its distance d from the live depth,
///     across the surface, with that depth's noise sigma.
///
/// A frame shows a vertex that was in the image in the frame before, too, if
/// its nearest node was seen (FrameMotions::seen), it faces the camera and lies
/// on live depth where its own surface is the one in view, not beside an edge.
/// To favour the best views more than that, by powers of the product, gains no
/// sharpness, and the colours agree less with the images (docs/ablation.md).
/// Not in the paper; compare Maier et al. 2015, Waechter et al. 2014.
///
/// In every frame, in order of time: Place(), Draw() if it may hide others,
/// Add().
class BestViewColors {
 public:
  /// Of the vertices of the surface with this id; `model` has normals and at
  /// least one node, must outlive this and has its final motions.
  /// `neighbors_per_point`: K of Eq. 3.
  BestViewColors(int surface, const SurfaceModel& model,
                 int neighbors_per_point);

  /// Carries the vertices into a frame.
  void Place(int frame);

  /// Draws what had been seen of the surface by then; its triangles are counted
  /// from `first` on. Returns their number.
  int Draw(const PinholeCamera& camera, int first, Raster* raster) const;

  /// Takes colours from a frame of which the surface has motions. Needs camera,
  /// depth, edges, colour and, by pixel, the surface in view, `labels`.
  void Add(const LiveView& live);

  /// Id of the surface.
  int surface() const { return surface_; }
  /// Motions of the frame in hand; null: the surface has none for it.
  const FrameMotions* motions() const {
    return motions_ ? &*motions_ : nullptr;
  }
  /// Vertices as Place() left them, camera frame, metres; of those that are not
  /// in use it says nothing.
  const std::vector<Eigen::Vector3f>& placed() const { return placed_; }
  /// Whether a vertex is of a part that is in use in the frame in hand.
  bool IsInUse(std::size_t vertex) const { return in_use_[vertex] != 0; }
  /// Number of nodes of the surface.
  int nodes() const { return graph_.size(); }
  /// The node that moves a vertex most.
  int NodeOf(std::size_t vertex) const;

  /// Red, green, blue by vertex; those that no frame showed keep theirs.
  std::vector<std::array<std::uint8_t, 3>> Colors() const;

 private:
  /// What is known of a vertex.
  struct Vertex {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // Weighted, RGB.
    float weight = 0;
    Eigen::Vector2f pixel = Eigen::Vector2f::Zero();  // In the last frame.
  };

  /// A rigid surface has one for all.
  const Skinning& SkinningOf(std::size_t vertex) const {
    return skinning_[skinning_.size() == 1 ? 0 : vertex];
  }

  int surface_;
  const SurfaceModel& model_;
  std::vector<Skinning> skinning_;
  std::vector<Vertex> vertices_;
  std::optional<FrameMotions> motions_;  // Of the frame in hand.
  DeformationGraph graph_;               // With these.
  std::vector<Eigen::Vector3f> placed_;  // Camera frame, metres.
  std::vector<char> in_use_;             // By vertex, in the frame in hand.
  int last_frame_ = -1;                  // Of Vertex::pixel; -1: none.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_RENDER_BEST_VIEW_COLORS_H_
