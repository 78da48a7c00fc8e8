#include "splitfusion/lib/render/best_view_colors.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// Colour between the pixels, BGR.
cv::Vec3f Interpolated(const cv::Mat& color, const Eigen::Vector2f& place) {
  const int u = std::clamp(static_cast<int>(place.x()), 0, color.cols - 2);
  const int v = std::clamp(static_cast<int>(place.y()), 0, color.rows - 2);
  const float a = std::clamp(place.x() - static_cast<float>(u), 0.0f, 1.0f);
  const float b = std::clamp(place.y() - static_cast<float>(v), 0.0f, 1.0f);
  const auto at = [&](int row, int column) {
    return cv::Vec3f(color.at<cv::Vec3b>(row, column));
  };
  return (1 - b) * ((1 - a) * at(v, u) + a * at(v, u + 1)) +
         b * ((1 - a) * at(v + 1, u) + a * at(v + 1, u + 1));
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

/// The node that moves a point most.
int StrongestNode(const Skinning& skinning) {
  const auto begin = skinning.weights.begin();
  return skinning
      .nodes[std::max_element(begin, begin + skinning.count) - begin];
}

}  // namespace

BestViewColors::BestViewColors(const SurfaceModel& model,
                               int neighbors_per_point)
    : model_(model),
      skinning_(SkinningIndex(model.graph, neighbors_per_point)
                    .Skin(model.mesh.vertices)),
      vertices_(model.mesh.vertices.size()) {}

void BestViewColors::Add(int frame, const LiveView& live) {
  const FrameMotions* motions = model_.history.Find(frame);
  if (motions == nullptr) return;
  DeformationGraph graph = model_.graph;
  graph.motions = motions->motions;
  const WarpField warp(graph);
  // Since the frame before, frames.
  const auto passed =
      static_cast<float>(last_frame_ < 0 ? 0 : frame - last_frame_);
  const auto add = [&](std::size_t i) {
    Vertex& vertex = vertices_[i];
    const Eigen::Vector3f point =
        warp.WarpPoint(skinning_[i], model_.mesh.vertices[i]);
    const auto pixel = live.camera.PixelOf(point);
    const Eigen::Vector2f before = vertex.pixel;
    vertex.pixel = pixel ? live.camera.Project(point) : Nowhere();
    if (!pixel || !motions->Saw(StrongestNode(skinning_[i]))) return;
    const float way =
        passed > 0 ? (vertex.pixel - before).norm() / passed : 0.0f;
    const float quality = QualityOf(
        live, point, warp.WarpNormal(skinning_[i], model_.mesh.normals[i]),
        *pixel, way);
    if (!(quality > 0)) return;  // Nor if it was not in the image before.
    const cv::Vec3f bgr = Interpolated(live.color, vertex.pixel);
    vertex.sum += quality * Eigen::Vector3f(bgr[2], bgr[1], bgr[0]);
    vertex.weight += quality;
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, vertices_.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        add(i);
                      }
                    });
  last_frame_ = frame;
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
