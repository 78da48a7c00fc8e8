#ifndef SPLITFUSION_TESTS_SPLIT_LAYERED_SCENE_H_
#define SPLITFUSION_TESTS_SPLIT_LAYERED_SCENE_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/geometry/point_map.h"
#include "splitfusion/lib/segmentation/segmenter.h"
#include "splitfusion/lib/sequence/frame.h"
#include "splitfusion/lib/split/split_options.h"

namespace splitfusion {

/// Camera of the scenes: 160x120.
inline PinholeCamera SceneCamera() { return {160, 120, 140, 140, 80, 60}; }

/// Options for so small an image.
inline SplitOptions SceneOptions() {
  SplitOptions options;
  options.graph_cut.core_erosion = 3;
  options.graph_cut.outer_dilation = 6;
  options.min_pixels = 150;
  return options;
}

/// A frame of upright cards before a wall, with Kinect-like noise; the truth
/// is known.
class LayeredScene {
 public:
  /// A wall at `wall_depth` metres.
  explicit LayeredScene(double wall_depth = 3.0, std::uint64_t seed = 1)
      : random_(seed),
        depth_(120, 160, static_cast<float>(wall_depth)),
        color_(120, 160, cv::Vec3b(120, 120, 120)),
        truth_(120, 160, std::uint16_t(0)) {}

  /// Puts a card into the scene, where it is nearer than what is there. The
  /// colour follows from the id.
  LayeredScene& Add(const cv::Rect& rect, double depth, int id) {
    const cv::Rect seen = rect & cv::Rect(0, 0, 160, 120);
    for (int v = seen.y; v < seen.br().y; ++v) {
      for (int u = seen.x; u < seen.br().x; ++u) {
        if (depth_(v, u) < depth) continue;
        depth_(v, u) = static_cast<float>(depth);
        truth_(v, u) = static_cast<std::uint16_t>(id);
        color_(v, u) = cv::Vec3b(static_cast<uchar>(40 * id), 30,
                                 static_cast<uchar>(250 - 60 * id));
      }
    }
    return *this;
  }

  /// The frame, with noise of the depth's own scale.
  Frame MakeFrame(int index) {
    Frame frame;
    frame.index = index;
    frame.timestamp = index / 30.0;
    frame.color = color_.clone();
    frame.depth = depth_.clone();
    for (float& z : cv::Mat_<float>(frame.depth)) {
      z += static_cast<float>(random_.gaussian(0.5 * DepthNoise().Sigma(z)));
    }
    return frame;
  }

  /// Pixels that show card `id`, 255.
  cv::Mat_<uchar> Truth(int id) const { return truth_ == id; }

  /// Depth without noise, metres.
  const cv::Mat_<float>& depth() const { return depth_; }

 private:
  cv::RNG random_;
  cv::Mat_<float> depth_;
  cv::Mat_<cv::Vec3b> color_;
  cv::Mat_<std::uint16_t> truth_;
};

/// `mask` moved by (dx, dy) pixels.
inline cv::Mat_<uchar> Moved(const cv::Mat_<uchar>& mask, int dx, int dy) {
  cv::Mat_<uchar> moved(mask.size(), uchar(0));
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const cv::Point to(u + dx, v + dy);
      if (mask(v, u) && to.x >= 0 && to.y >= 0 && to.x < mask.cols &&
          to.y < mask.rows) {
        moved(to) = 255;
      }
    }
  }
  return moved;
}

/// 255 inside of the rectangle, image of 160x120.
inline cv::Mat_<uchar> RectMask(const cv::Rect& rect) {
  cv::Mat_<uchar> mask(120, 160, uchar(0));
  mask(rect & cv::Rect(0, 0, 160, 120)) = 255;
  return mask;
}

/// Intersection over union of two masks; 1 if both are empty.
inline double Iou(const cv::Mat& a, const cv::Mat& b) {
  const int both = cv::countNonZero(a | b);
  return both == 0 ? 1.0 : double(cv::countNonZero(a & b)) / both;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SPLIT_LAYERED_SCENE_H_
