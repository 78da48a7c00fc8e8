#include "splitfusion/lib/frame/rolling_shutter.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/frame/depth_edges.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// How far row v lies below the middle, as a share of the height.
float ShareOfRow(float v, int rows) {
  return (v + 0.5f) / static_cast<float>(rows) - 0.5f;
}

/// Depth of pixels without one, for which only rotations are known.
float TypicalDepth(const cv::Mat_<float>& depth) {
  constexpr int kStride = 4;  // Speed.
  std::vector<float> known;
  for (int v = 0; v < depth.rows; v += kStride) {
    for (int u = 0; u < depth.cols; u += kStride) {
      if (depth(v, u) > 0) known.push_back(depth(v, u));
    }
  }
  return known.empty() ? 1.f : Median(std::move(known));
}

}  // namespace

RollingShutter::RollingShutter(const cv::Mat_<float>& depth,
                               const PinholeCamera& camera,
                               const Rigid3d& motion)
    : depth_(depth),
      camera_(camera),
      motion_(motion.cast<float>()),
      places_(depth.size()) {
  const float typical = TypicalDepth(depth);
  tbb::parallel_for(0, depth.rows, [&](int v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = depth(v, u) > 0 ? depth(v, u) : typical;
      const Eigen::Vector3f point = camera.BackProject<float>(u, v, z);
      const Eigen::Vector3f moved = Moved(point);
      Eigen::Vector2f place(u, v);
      for (int step = 0; step < 2; ++step) {  // The row is where it lands.
        const Eigen::Vector3f then =
            point + ShareOfRow(place.y(), depth.rows) * moved;
        place = camera.Project(then);
      }
      places_(v, u) = {place.x(), place.y()};
    }
  });
}

float RollingShutter::SampleDepth(const cv::Vec2f& place) const {
  const auto pixel = camera_.PixelAt({place[0], place[1]});
  if (!pixel) return 0;
  const float nearest = depth_(pixel->y(), pixel->x());
  const int u = cvFloor(place[0]), v = cvFloor(place[1]);
  if (nearest == 0 || u < 0 || v < 0 || u + 1 >= depth_.cols ||
      v + 1 >= depth_.rows) {
    return nearest;
  }
  const float corners[] = {depth_(v, u), depth_(v, u + 1), depth_(v + 1, u),
                           depth_(v + 1, u + 1)};
  const auto [least, most] = std::minmax_element(corners, corners + 4);
  const float jump =
      EdgeJump(*least, 1, static_cast<float>(camera_.fx), camera_.noise);
  if (*least == 0 || IsDepthJump(*least, *most, jump)) return nearest;
  const float a = place[0] - static_cast<float>(u);
  const float b = place[1] - static_cast<float>(v);
  return (1 - b) * ((1 - a) * corners[0] + a * corners[1]) +
         b * ((1 - a) * corners[2] + a * corners[3]);
}

cv::Mat_<float> RollingShutter::Depth() const {
  cv::Mat_<float> unrolled(depth_.size());
  tbb::parallel_for(0, depth_.rows, [&](int v) {
    for (int u = 0; u < depth_.cols; ++u) {
      const cv::Vec2f& place = places_(v, u);
      const float z = SampleDepth(place);
      const Eigen::Vector3f moved =
          Moved(camera_.BackProject(place[0], place[1], z));
      const float then = z - ShareOfRow(place[1], depth_.rows) * moved.z();
      unrolled(v, u) = z > 0 ? std::max(then, 0.f) : 0;
    }
  });
  return unrolled;
}

}  // namespace splitfusion
