#include "splitfusion/lib/split/graph_cut.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <cstring>
#include <opencv2/imgproc/detail/gcgraph.hpp>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/depth_comparison.h"
#include "splitfusion/lib/geometry/point_map.h"

namespace splitfusion {
namespace {

/// Weights are cut as integers, so that the result is exact.
constexpr float kUnit = 1000.0f;  // Unit.

constexpr int kDirections = 4;  // Layout: the other four are these reversed.

using Weights = cv::Mat_<cv::Vec4i>;  // Per pixel: edges to the 4 offsets.

/// Edge weights between neighbouring points.
class EdgeWeight {
 public:
  EdgeWeight(const PointMap& points, const cv::Mat& color,
             const GraphCutOptions& options)
      : points_(points), color_(color), options_(options) {}

  /// 0..1; both pixels have depth.
  float operator()(const cv::Point& p, const cv::Point& q) const {
    const cv::Vec3f step = points_.points(q) - points_.points(p);
    const cv::Vec3f& np = points_.normals(p);
    const cv::Vec3f& nq = points_.normals(q);
    const float distance =
        std::max({0.25f * std::abs(step[2]), PlaneDistance(np, step),
                  PlaneDistance(nq, step)});
    const DepthTolerance<double> step_scale = {options_.step_offset,
                                               options_.step_factor};
    const auto scale =
        static_cast<float>(step_scale.At(points_.points(p)[2], points_.noise));
    const float ratio = distance / scale;
    if (ratio > 3) return 0;
    const float exponent = ratio * ratio + NormalTerm(np, nq, step);
    return std::exp(-exponent) * ColorFactor(p, q);
  }

 private:
  static float PlaneDistance(const cv::Vec3f& normal, const cv::Vec3f& step) {
    // Without a normal: as if it faced the camera.
    if (normal[2] == 0) return std::abs(step[2]);
    return std::abs(normal.dot(step));
  }

  float NormalTerm(const cv::Vec3f& np, const cv::Vec3f& nq,
                   const cv::Vec3f& step) const {
    if (np[2] == 0 || nq[2] == 0) return 0;
    const float turn = std::max(0.0f, 1 - np.dot(nq));
    const bool convex = (nq - np).dot(step) > 0;
    return turn / static_cast<float>(convex ? options_.convex_scale
                                            : options_.concave_scale);
  }

  float ColorFactor(const cv::Point& p, const cv::Point& q) const {
    const cv::Vec3b& a = color_.at<cv::Vec3b>(p);
    const cv::Vec3b& b = color_.at<cv::Vec3b>(q);
    float square = 0;
    for (int c = 0; c < 3; ++c) square += float(a[c] - b[c]) * (a[c] - b[c]);
    const float scale = static_cast<float>(options_.color_scale);
    const float share = static_cast<float>(options_.color_share);
    return 1 - share * square / (square + scale * scale);
  }

  const PointMap& points_;
  const cv::Mat& color_;
  const GraphCutOptions& options_;
};

/// The grid graph over the pixels of a crop that are in question.
class GridGraph {
 public:
  GridGraph(const PointMap& points, const cv::Mat& color, const cv::Rect& crop,
            const cv::Mat_<float>& evidence, const GraphCutOptions& options)
      : points_(points.points(crop)),
        evidence_(evidence),
        node_(evidence.size(), kNone) {
    const EdgeWeight weight(points, color, options);
    NumberNodes();
    ComputeWeights(weight, crop.tl());
  }

  cv::Mat_<uchar> Cut() {
    cv::Mat_<uchar> foreground(evidence_.size(), uchar(0));
    if (nodes_ == 0) return foreground;
    cv::detail::GCGraph<int> graph(nodes_ + 2, 2 * kDirections * nodes_);
    AddTerminals(&graph);
    AddEdges(&graph);
    graph.maxFlow();
    for (int v = 0; v < node_.rows; ++v) {
      for (int u = 0; u < node_.cols; ++u) {
        const int node = node_(v, u);
        if (node >= 0 && graph.inSourceSegment(node)) foreground(v, u) = 255;
      }
    }
    return foreground;
  }

 private:
  static constexpr int kNone = -1;        // Layout: no depth.
  static constexpr int kBackground = -2;  // Layout: certain.

  void NumberNodes() {
    for (int v = 0; v < node_.rows; ++v) {
      for (int u = 0; u < node_.cols; ++u) {
        if (points_(v, u)[2] <= 0) continue;
        const bool certain = evidence_(v, u) <= kSurelyBackground;
        node_(v, u) = certain ? kBackground : nodes_++;
      }
    }
  }

  void ComputeWeights(const EdgeWeight& weight, const cv::Point& origin) {
    weights_.create(node_.size());
    tbb::parallel_for(0, node_.rows, [&](int v) {
      for (int u = 0; u < node_.cols; ++u) {
        for (int k = 0; k < kDirections; ++k) {
          weights_(v, u)[k] = WeightOf(weight, origin, {u, v}, k);
        }
      }
    });
  }

  int WeightOf(const EdgeWeight& weight, const cv::Point& origin,
               const cv::Point& p, int direction) const {
    const cv::Point q = p + offsets_[direction];
    if (!Inside(q) || node_(p) == kNone || node_(q) == kNone ||
        (node_(p) < 0 && node_(q) < 0)) {
      return 0;
    }
    const float length = direction < 2 ? 1.0f : 1.41421356f;  // Maths.
    return static_cast<int>(kUnit * weight(origin + p, origin + q) / length);
  }

  bool Inside(const cv::Point& p) const {
    return p.x >= 0 && p.x < node_.cols && p.y < node_.rows;
  }

  void AddTerminals(cv::detail::GCGraph<int>* graph) const {
    for (int v = 0; v < node_.rows; ++v) {
      for (int u = 0; u < node_.cols; ++u) {
        if (node_(v, u) < 0) continue;
        graph->addVtx();
        // Without any evidence a pixel belongs to the background.
        const int weight = static_cast<int>(kUnit * evidence_(v, u)) - 1;
        graph->addTermWeights(node_(v, u), std::max(0, weight),
                              std::max(0, -weight));
      }
    }
  }

  void AddEdges(cv::detail::GCGraph<int>* graph) const {
    // The solver wants at least one edge: one between two idle vertices.
    graph->addEdges(graph->addVtx(), graph->addVtx(), 1, 1);
    for (int v = 0; v < node_.rows; ++v) {
      for (int u = 0; u < node_.cols; ++u) {
        for (int k = 0; k < kDirections; ++k) {
          const int weight = weights_(v, u)[k];
          if (weight == 0) continue;
          AddEdge(node_(v, u), node_(cv::Point(u, v) + offsets_[k]), weight,
                  graph);
        }
      }
    }
  }

  /// An edge to a certain pixel ends in the sink.
  static void AddEdge(int a, int b, int weight,
                      cv::detail::GCGraph<int>* graph) {
    if (a >= 0 && b >= 0) {
      graph->addEdges(a, b, weight, weight);
    } else {
      graph->addTermWeights(std::max(a, b), 0, weight);
    }
  }

  const std::array<cv::Point, kDirections> offsets_ = {
      cv::Point(1, 0), cv::Point(0, 1), cv::Point(1, 1), cv::Point(-1, 1)};
  const cv::Mat_<cv::Vec3f> points_;
  const cv::Mat_<float>& evidence_;
  cv::Mat_<int> node_;
  Weights weights_;
  int nodes_ = 0;
};

}  // namespace

void GraphCutOptions::List(OptionList* list) {
  list->Number("core_erosion", &core_erosion, {1, 100}, "pixels",
               "So far inside of a mask its evidence has its full weight.");
  list->Number("outer_dilation", &outer_dilation, {1, 200}, "pixels",
               "What is farther from mask and predicted surface is certain "
               "background.");
  list->Number(
      "step_factor", &step_factor, Range::Above(0), "",
      "A depth step of so many times the noise lowers the weight of an "
      "edge to 1/e.");
  list->Number("step_offset", &step_offset, Range::AtLeast(0), "metres",
               "Added to that step.");
  list->Number("concave_scale", &concave_scale, Range::Above(0), "",
               "1 - cos of the angle between normals that lowers the weight of "
               "an edge to 1/e where the surface is concave.");
  list->Number("convex_scale", &convex_scale, Range::Above(0), "",
               "The same where it is convex.");
  list->Number("color_scale", &color_scale, Range::Above(0), "grey values",
               "Difference of colour with half of the full effect.");
  list->Number("color_share", &color_share, Range::Share(), "",
               "Largest share of an edge's weight that colour can remove.");
}

cv::Mat_<uchar> CutForeground(const PointMap& points, const cv::Mat& color,
                              const cv::Rect& crop,
                              const cv::Mat_<float>& evidence,
                              const GraphCutOptions& options) {
  if (evidence.size() != crop.size()) {
    throw InputError("evidence of the graph cut is " +
                     std::to_string(evidence.cols) + "x" +
                     std::to_string(evidence.rows) + ": expected the size " +
                     std::to_string(crop.width) + "x" +
                     std::to_string(crop.height) + " of the crop");
  }
  return GridGraph(points, color, crop, evidence, options).Cut();
}

}  // namespace splitfusion
