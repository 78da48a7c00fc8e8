#include "splitfusion/lib/frame/color_registration.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// For every pixel that of the nearest one of `mask` (255), as an index into
/// the image; all -1 if there is none.
cv::Mat_<int> NearestOf(const cv::Mat_<uchar>& mask) {
  if (cv::countNonZero(mask) == 0) return {mask.size(), -1};
  cv::Mat distances, labels;
  cv::distanceTransform(mask == 0, distances, labels, cv::DIST_L2, 5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<int> pixel_of(mask.total() + 1, -1);
  for (int i = 0; i < static_cast<int>(mask.total()); ++i) {
    if (mask(i) != 0) pixel_of[labels.at<int>(i)] = i;
  }
  cv::Mat_<int> nearest(mask.size());
  for (int i = 0; i < static_cast<int>(mask.total()); ++i) {
    nearest(i) = pixel_of[labels.at<int>(i)];
  }
  return nearest;
}

/// The colour camera's image plane in cells about as large as a depth pixel, so
/// that the points of a surface leave no cells between them empty.
class Cells {
 public:
  Cells(const PinholeCamera& depth_camera, const ColorCamera& color_camera) {
    const cv::Size depth_size(depth_camera.width, depth_camera.height);
    const cv::Size size = color_camera.SizeBeside(depth_size);
    size_ = depth_size;
    if (size == depth_size) return;
    scale_ = static_cast<float>(depth_camera.fx / color_camera.fx);
    size_.width = cvCeil(static_cast<float>(size.width) * scale_);
    size_.height = cvCeil(static_cast<float>(size.height) * scale_);
  }

  const cv::Size& size() const { return size_; }

  /// Where a place of the colour image is; none beyond it.
  std::optional<cv::Point> At(const cv::Vec2f& place) const {
    const float u = place[0] * scale_, v = place[1] * scale_;
    // Also false for what is not a number.
    const bool is_inside = u >= -0.5f && v >= -0.5f &&
                           u < static_cast<float>(size_.width) &&
                           v < static_cast<float>(size_.height);
    if (!is_inside) return std::nullopt;
    const cv::Point cell(cvRound(u), cvRound(v));
    if (!cv::Rect({0, 0}, size_).contains(cell)) return std::nullopt;
    return cell;
  }

 private:
  cv::Size size_;
  float scale_ = 1;
};

/// Least depth of what falls into each cell and into its neighbours: a surface
/// seen closer leaves some empty nevertheless.
cv::Mat_<float> LeastDepths(const Cells& cells,
                            const cv::Mat_<cv::Vec2f>& places,
                            const cv::Mat_<float>& depth,
                            const cv::Mat_<uchar>& measured) {
  constexpr float kFar = std::numeric_limits<float>::max();  // Maths.
  cv::Mat_<float> least(cells.size(), kFar);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (measured(v, u) == 0) continue;
      const std::optional<cv::Point> cell = cells.At(places(v, u));
      if (cell) least(*cell) = std::min(least(*cell), depth(v, u));
    }
  }
  cv::Mat_<float> around;
  cv::erode(least, around, cv::Mat::ones(3, 3, CV_8U));
  return around;
}

/// The nearest pixel of `seen` in the row or column of (u, v) that is not on
/// something clearly nearer: what hides it is no substitute. Itself if none is.
cv::Point SeenBeside(int u, int v, const cv::Mat_<float>& depth,
                     const cv::Mat_<uchar>& seen, float tolerance) {
  const cv::Point directions[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  const cv::Rect image({0, 0}, depth.size());
  const cv::Point self(u, v);
  for (int step = 1; step < depth.cols; ++step) {
    for (const cv::Point& direction : directions) {
      const cv::Point p = self + step * direction;
      if (image.contains(p) && seen(p) != 0 &&
          depth(p) > depth(self) - tolerance) {
        return p;
      }
    }
  }
  return self;
}

}  // namespace

cv::Mat_<cv::Vec2f> ColorPlaces(const PinholeCamera& depth_camera,
                                const ColorCamera& color_camera,
                                const cv::Mat_<float>& depth) {
  const Rigid3f color_from_depth = color_camera.color_from_depth.cast<float>();
  const auto fx = static_cast<float>(color_camera.fx);
  const auto fy = static_cast<float>(color_camera.fy);
  const auto cx = static_cast<float>(color_camera.cx);
  const auto cy = static_cast<float>(color_camera.cy);
  const cv::Mat_<uchar> measured = depth > 0;
  const cv::Mat_<int> nearest = NearestOf(measured);
  cv::Mat_<cv::Vec2f> places(depth.size());
  cv::Mat_<float> color_depth(depth.size());
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      // Without any depth as if all were far away.
      const int from = nearest(v, u);
      const float z =
          from < 0 ? static_cast<float>(depth_camera.fx) : depth(from);
      const Eigen::Vector3f point =
          color_from_depth * depth_camera.BackProject<float>(u, v, z);
      color_depth(v, u) = point.z();
      places(v, u) = {fx * point.x() / point.z() + cx,
                      fy * point.y() / point.z() + cy};
    }
  });
  const Cells cells(depth_camera, color_camera);
  const cv::Mat_<float> least =
      LeastDepths(cells, places, color_depth, measured);
  cv::Mat_<uchar> seen(depth.size(), uchar(255));
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      const std::optional<cv::Point> cell = cells.At(places(v, u));
      if (!cell) continue;
      const float z = color_depth(v, u);
      if (least(*cell) < z - kOneBody.At(z, depth_camera.noise)) seen(v, u) = 0;
    }
  });
  cv::Mat_<cv::Vec2f> result = places.clone();
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (seen(v, u) != 0) continue;
      const float tolerance =
          kOneBody.At(color_depth(v, u), depth_camera.noise);
      result(v, u) = places(SeenBeside(u, v, color_depth, seen, tolerance));
    }
  });
  return result;
}

cv::Mat RegisterColor(const cv::Mat& color, const cv::Mat_<cv::Vec2f>& places) {
  cv::Mat registered;
  cv::remap(color, registered, places, cv::Mat(), cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
  return registered;
}

cv::Mat_<uchar> RegisterMask(const cv::Mat_<uchar>& mask,
                             const cv::Mat_<cv::Vec2f>& places) {
  cv::Mat registered;
  cv::remap(mask, registered, places, cv::Mat(), cv::INTER_NEAREST,
            cv::BORDER_CONSTANT, cv::Scalar(0));
  return registered;
}

}  // namespace splitfusion
