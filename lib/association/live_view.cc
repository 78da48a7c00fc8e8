#include "splitfusion/lib/association/live_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kEdgeRadius = 2;  // Pixels.

/// Jump of depth that is an edge: more than noise or a slanted surface gives.
float EdgeJump(float depth) { return 0.015f * depth + 3 * DepthSigma(depth); }

/// 255 where a pixel lies next to a jump of depth (either side of it).
cv::Mat_<std::uint8_t> DepthEdges(const cv::Mat_<float>& depth) {
  cv::Mat_<std::uint8_t> edges(depth.size(), 0);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = depth(v, u);
      if (!(z > 0)) continue;
      const auto compare = [&](int v2, int u2) {
        if (v2 >= depth.rows || u2 >= depth.cols) return;
        const float other = depth(v2, u2);
        if (other > 0 && std::abs(other - z) > EdgeJump(std::min(z, other))) {
          edges(v, u) = edges(v2, u2) = 255;
        }
      };
      // Two pixels away too: edges come with a column of holes.
      for (int step = 1; step <= 2; ++step) {
        compare(v, u + step);
        compare(v + step, u);
      }
    }
  }
  cv::Mat_<std::uint8_t> wide;
  const int size = 2 * (kEdgeRadius - 1) + 1;
  cv::dilate(edges, wide, cv::Mat::ones(size, size, CV_8U));
  return wide;
}

}  // namespace

LiveView MakeLiveView(const PinholeCamera& camera, const cv::Mat& depth,
                      const cv::Mat& color) {
  if (color.type() != CV_8UC3 || color.size() != depth.size()) {
    throw InputError("colour image is " + std::to_string(color.cols) + "x" +
                     std::to_string(color.rows) + " of type " +
                     std::to_string(color.type()) + ": expected 8UC3 of " +
                     std::to_string(depth.cols) + "x" +
                     std::to_string(depth.rows));
  }
  LiveView view;
  view.camera = camera;
  view.map = ComputePointMap(depth, camera);
  view.color = color;
  view.depth = depth;
  view.edges = DepthEdges(view.depth);
  view.labels.create(depth.size());
  view.labels.setTo(0);
  view.uncertain.create(depth.size());
  view.uncertain.setTo(0);
  view.confidence.create(depth.size());
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      const cv::Vec3f& p = view.map.points(v, u);
      const cv::Vec3f& n = view.map.normals(v, u);
      const float length = std::sqrt(p.dot(p));
      view.confidence(v, u) =
          length > 0 ? DepthConfidence(p[2]) *
                           std::max(0.0f, -p.dot(n) / length)
                     : 0.0f;
    }
  });
  return view;
}

}  // namespace splitfusion
