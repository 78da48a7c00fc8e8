#include "splitfusion/lib/frame/color_registration.h"

#include <tbb/parallel_for.h>

#include <limits>
#include <opencv2/imgproc.hpp>
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

/// Least depth of what falls into each pixel of the colour image, and into its
/// neighbours: points of a surface seen closer leave pixels between them empty.
cv::Mat_<float> LeastDepths(const cv::Mat_<cv::Vec2f>& places,
                            const cv::Mat_<float>& depth,
                            const cv::Mat_<uchar>& measured) {
  constexpr float kFar = std::numeric_limits<float>::max();  // Maths.
  cv::Mat_<float> least(depth.size(), kFar);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      if (measured(v, u) == 0) continue;
      const int x = cvRound(places(v, u)[0]), y = cvRound(places(v, u)[1]);
      if (x < 0 || y < 0 || x >= depth.cols || y >= depth.rows) continue;
      least(y, x) = std::min(least(y, x), depth(v, u));
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
  const cv::Mat_<float> least = LeastDepths(places, color_depth, measured);
  cv::Mat_<uchar> seen(depth.size(), uchar(255));
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      const int x = cvRound(places(v, u)[0]), y = cvRound(places(v, u)[1]);
      if (x < 0 || y < 0 || x >= depth.cols || y >= depth.rows) continue;
      const float z = color_depth(v, u);
      if (least(y, x) < z - kOneBody.At(z, depth_camera.noise)) seen(v, u) = 0;
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
