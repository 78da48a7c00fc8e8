#include "splitfusion/lib/split/surface_contact.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr int kContactReach = 3;  // Pixels.

/// True if a pixel of `body` near (u, v) continues the surface there.
bool Touches(const PointMap& points, const cv::Mat_<uchar>& body, int u,
             int v) {
  const cv::Vec3f& point = points.points(v, u);
  const int v_end = std::min(v + kContactReach, body.rows - 1);
  const int u_end = std::min(u + kContactReach, body.cols - 1);
  for (int j = std::max(0, v - kContactReach); j <= v_end; ++j) {
    for (int i = std::max(0, u - kContactReach); i <= u_end; ++i) {
      if (!body(j, i) || points.points(j, i)[2] <= 0) continue;
      const cv::Vec3f step = points.points(j, i) - point;
      const float sideways = std::hypot(step[0], step[1]);
      if (!IsDepthJump(point[2], points.points(j, i)[2],
                       sideways + kNoiseAlone.At(point[2], points.noise))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

double ContactShare(const PointMap& points, const cv::Mat_<uchar>& piece,
                    const cv::Mat_<uchar>& body) {
  cv::Mat_<uchar> inner;
  cv::erode(piece, inner, cv::Mat::ones(3, 3, CV_8U));
  int border = 0, touching = 0;
  for (int v = 0; v < piece.rows; ++v) {
    for (int u = 0; u < piece.cols; ++u) {
      if (!piece(v, u) || inner(v, u) || points.points(v, u)[2] <= 0) continue;
      ++border;
      touching += Touches(points, body, u, v);
    }
  }
  return border > 0 ? double(touching) / border : 0.0;
}

}  // namespace splitfusion
