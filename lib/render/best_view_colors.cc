#include "splitfusion/lib/render/best_view_colors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/visibility/seen_triangles.h"

namespace splitfusion {
namespace {

/// Vertices that one task looks at.
constexpr int kGrain = 1024;  // Speed.

/// BGR between the pixels.
cv::Vec3f ColorBetweenPixels(const cv::Mat& color,
                             const Eigen::Vector2f& place) {
  const float x = std::clamp(place.x(), 0.0f, color.cols - 1.0f);
  const float y = std::clamp(place.y(), 0.0f, color.rows - 1.0f);
  const int u = static_cast<int>(x), v = static_cast<int>(y);
  const int right = std::min(u + 1, color.cols - 1);
  const int below = std::min(v + 1, color.rows - 1);
  const float a = x - static_cast<float>(u), b = y - static_cast<float>(v);
  const auto at = [&](int row, int column) {
    return cv::Vec3f(color.at<cv::Vec3b>(row, column));
  };
  return (1 - b) * ((1 - a) * at(v, u) + a * at(v, right)) +
         b * ((1 - a) * at(below, u) + a * at(below, right));
}

/// How well a frame shows a point of the surface, see BestViewColors; 0: not at
/// all. Camera frame, metres; `pixel`: that of the point; `way`: in the image
/// since the frame before, pixels.
float QualityOf(const LiveView& live, const Eigen::Vector3f& point,
                const Eigen::Vector3f& normal, const Eigen::Vector2i& pixel,
                float way) {
  const float cosine = -normal.dot(point.normalized());
  const float depth = live.depth(pixel.y(), pixel.x());
  const DepthNoise& noise = live.camera.noise;
  if (cosine <= 0 || live.edges(pixel.y(), pixel.x()) != 0 ||
      ClassifyDepth(depth, point.z(), kNoiseAlone.At(depth, noise)) !=
          DepthState::kObserved) {
    return 0;
  }
  const float off =
      cosine * (depth - point.z()) / static_cast<float>(noise.Sigma(depth));
  return cosine / (point.z() * point.z()) / (1 + way / 2) *
         std::exp(-off * off / 2);
}

/// Not in the image.
Eigen::Vector2f Nowhere() {
  return Eigen::Vector2f::Constant(std::numeric_limits<float>::quiet_NaN());
}

/// That of vertices; one for all of a rigid surface.
std::vector<Skinning> SkinningOfAll(const SurfaceModel& model,
                                    int neighbors_per_point) {
  const SkinningIndex index(model.graph, neighbors_per_point);
  if (!model.graph.rigid()) return index.Skin(model.mesh.vertices);
  return {index.Skin(Eigen::Vector3f::Zero().eval())};
}

/// Calls visit(i) for the vertices of a mesh, in parallel.
template <typename Visit>
void ForEachVertex(std::size_t count, const Visit& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        visit(i);
                      }
                    });
}

}  // namespace

BestViewColors::BestViewColors(int surface, const SurfaceModel& model,
                               int neighbors_per_point)
    : surface_(surface),
      model_(model),
      skinning_(SkinningOfAll(model, neighbors_per_point)),
      vertices_(model.mesh.vertices.size()),
      graph_(model.graph),
      placed_(model.mesh.vertices.size()),
      in_use_(model.mesh.vertices.size(), true) {
  graph_.motions.resize(graph_.size());
}

int BestViewColors::NodeOf(std::size_t vertex) const {
  const Skinning& skinning = SkinningOf(vertex);
  const auto begin = skinning.weights.begin();
  return skinning
      .nodes[std::max_element(begin, begin + skinning.count) - begin];
}

void BestViewColors::Place(int frame) {
  motions_ = model_.history.Find(frame);
  if (!motions_) return;
  motions_->SpreadTo(&graph_.motions);
  const WarpField warp(graph_);
  ForEachVertex(placed_.size(), [&](std::size_t i) {
    in_use_[i] = graph_.IsInUse(NodeOf(i), frame);
    if (!IsInUse(i)) return;
    placed_[i] = warp.WarpPoint(SkinningOf(i), model_.mesh.vertices[i]);
  });
}

int BestViewColors::Draw(const PinholeCamera& camera, int first,
                         Raster* raster) const {
  if (!motions_) return 0;
  const std::vector<Eigen::Vector3i> triangles =
      graph_.rigid()
          ? model_.mesh.triangles
          : SeenTriangles(model_.mesh, skinning_, graph_, motions_->frame);
  RasterizeTriangles(placed_, triangles, camera, /*cull_back_faces=*/true,
                     first, raster);
  return static_cast<int>(triangles.size());
}

void BestViewColors::Add(const LiveView& live) {
  if (!motions_) return;
  const WarpField warp(graph_);
  // Since the frame before, frames.
  const auto passed =
      static_cast<float>(last_frame_ < 0 ? 0 : motions_->frame - last_frame_);
  ForEachVertex(vertices_.size(), [&](std::size_t i) {
    Vertex& vertex = vertices_[i];
    if (!IsInUse(i)) {
      vertex.pixel = Nowhere();
      return;
    }
    const Eigen::Vector3f& point = placed_[i];
    const auto pixel = live.camera.PixelOf(point);
    const Eigen::Vector2f before = vertex.pixel;
    vertex.pixel = pixel ? live.camera.Project(point) : Nowhere();
    if (!pixel || live.labels(pixel->y(), pixel->x()) != surface_ ||
        !motions_->Saw(NodeOf(i))) {
      return;
    }
    const float way =
        passed > 0 ? (vertex.pixel - before).norm() / passed : 0.0f;
    const float quality = QualityOf(
        live, point, warp.WarpNormal(SkinningOf(i), model_.mesh.normals[i]),
        *pixel, way);
    if (!(quality > 0)) return;  // Nor if it was not in the image before.
    const cv::Vec3f bgr = ColorBetweenPixels(live.color, vertex.pixel);
    vertex.sum += quality * Eigen::Vector3f(bgr[2], bgr[1], bgr[0]);
    vertex.weight += quality;
  });
  last_frame_ = motions_->frame;
}

std::vector<std::array<std::uint8_t, 3>> BestViewColors::Colors() const {
  std::vector<std::array<std::uint8_t, 3>> colors = model_.mesh.colors;
  colors.resize(vertices_.size());
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const Vertex& vertex = vertices_[i];
    if (!(vertex.weight > 0)) continue;
    for (int channel = 0; channel < 3; ++channel) {
      colors[i][channel] =
          cv::saturate_cast<std::uint8_t>(vertex.sum[channel] / vertex.weight);
    }
  }
  return colors;
}

}  // namespace splitfusion
