#include "splitfusion/lib/frame/live_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/frame/depth_edges.h"

namespace splitfusion {
namespace {

constexpr int kEdgeRadius = 2;  // Pixels.

/// Fills pixels without depth whose neighbours agree: single lost pixels would
/// leave holes as wide as a voxel where the camera stands still.
cv::Mat_<float> WithoutPinholes(const cv::Mat_<float>& depth,
                                const PinholeCamera& camera) {
  const auto focal_length = static_cast<float>(camera.fx);
  cv::Mat_<float> filled = depth.clone();
  tbb::parallel_for(1, std::max(1, depth.rows - 1), [&](int v) {
    for (int u = 1; u + 1 < depth.cols; ++u) {
      if (depth(v, u) > 0) continue;
      float sum = 0, low = 1e9f, high = 0;
      int count = 0;
      for (int k = 0; k < 9; ++k) {
        const float z = depth(v + k / 3 - 1, u + k % 3 - 1);
        if (!(z > 0)) continue;
        sum += z, ++count;
        low = std::min(low, z), high = std::max(high, z);
      }
      if (count >= 6 &&
          !IsDepthJump(low, high,
                       EdgeJump(low, 2, focal_length, camera.noise))) {
        filled(v, u) = sum / count;
      }
    }
  });
  return filled;
}

GreyLevel MakeGreyLevel(const cv::Mat& grey, double sigma) {
  GreyLevel level;
  cv::GaussianBlur(grey, level.value, cv::Size(), sigma);
  cv::Mat by_u, by_v;
  constexpr double kSobelScale = 1.0 / 8;  // Maths.
  cv::Sobel(level.value, by_u, CV_32F, 1, 0, 3, kSobelScale);
  cv::Sobel(level.value, by_v, CV_32F, 0, 1, 3, kSobelScale);
  cv::merge(std::vector<cv::Mat>{by_u, by_v}, level.gradient);
  return level;
}

/// 255 where a pixel lies next to a jump of depth (either side of it).
cv::Mat_<std::uint8_t> DepthEdges(const cv::Mat_<float>& depth,
                                  const PinholeCamera& camera) {
  cv::Mat_<float> bordered;
  cv::copyMakeBorder(depth, bordered, kEdgeBorder, kEdgeBorder, kEdgeBorder,
                     kEdgeBorder, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat_<std::uint8_t> edges(depth.size());
  tbb::parallel_for(0, depth.rows, [&](int v) {
    MarkEdges(bordered[v + kEdgeBorder] + kEdgeBorder,
              static_cast<int>(bordered.step1()), depth.cols,
              static_cast<float>(camera.fx), camera.noise, edges[v]);
  });
  cv::Mat_<std::uint8_t> wide;
  const int size = 2 * (kEdgeRadius - 1) + 1;
  cv::dilate(edges, wide, cv::Mat::ones(size, size, CV_8U));
  return wide;
}

}  // namespace

LiveView MakeLiveView(const PinholeCamera& camera, const cv::Mat& depth,
                      const cv::Mat& color, const PointMapOptions& options) {
  if (color.type() != CV_8UC3 || color.size() != depth.size()) {
    throw InputError("colour image is " + std::to_string(color.cols) + "x" +
                     std::to_string(color.rows) + " of type " +
                     std::to_string(color.type()) + ": expected 8UC3 of " +
                     std::to_string(depth.cols) + "x" +
                     std::to_string(depth.rows));
  }
  if (depth.type() != CV_32FC1) {
    throw InputError("depth image is of type " + std::to_string(depth.type()) +
                     ": expected CV_32FC1");
  }
  LiveView view;
  view.camera = camera;
  view.depth = WithoutPinholes(depth, camera);
  view.map = ComputePointMap(view.depth, camera, options);
  view.color = color;
  cv::Mat grey;
  cv::cvtColor(color, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F, 1.0 / 255);
  tbb::parallel_for(
      0, 2, [&](int k) { view.grey[k] = MakeGreyLevel(grey, kGreySigma[k]); });
  view.edges = DepthEdges(view.depth, camera);
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
      view.confidence(v, u) = length > 0
                                  ? camera.noise.Confidence(p[2]) *
                                        std::max(0.0f, -p.dot(n) / length)
                                  : 0.0f;
    }
  });
  return view;
}

std::map<int, int> PixelsOfSurfaces(const LiveView& live) {
  std::map<int, int> counts;
  for (int v = 0; v < live.depth.rows; ++v) {
    for (int u = 0; u < live.depth.cols;) {
      const int label = live.labels(v, u);
      int count = 0;
      for (; u < live.depth.cols && live.labels(v, u) == label; ++u) {
        count += live.depth(v, u) > 0;
      }
      if (count > 0) counts[label] += count;
    }
  }
  return counts;
}

}  // namespace splitfusion
