#include "splitfusion/lib/visibility/seen_space.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

constexpr int kInterval = 4;        // Frames.
constexpr std::size_t kViews = 12;  // Remembered at most.
constexpr int kWindow = 5;          // Pixels: room for errors of the pose.

}  // namespace

void SeenSpace::Add(int frame, const cv::Mat& depth,
                    const Rigid3d& world_from_camera) {
  if (!views_.empty() && frame - views_.back().frame < kInterval) return;
  View view{frame, {}, world_from_camera.inverse().cast<float>()};
  cv::erode(depth, view.depth, cv::Mat::ones(kWindow, kWindow, CV_8U));
  views_.push_back(view);
  if (views_.size() > kViews) Thin();
}

/// Drops the view that leaves the smallest gap in time, for its age: the gaps
/// grow with the age.
void SeenSpace::Thin() {
  std::size_t best = 1;
  double best_gap = INFINITY;
  for (std::size_t i = 1; i + 1 < views_.size(); ++i) {
    const double age = views_.back().frame - views_[i].frame;
    const double gap = (views_[i + 1].frame - views_[i - 1].frame) / age;
    if (gap >= best_gap) continue;
    best_gap = gap;
    best = i;
  }
  views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(best));
}

bool SeenSpace::LookedThrough(const View& view,
                              const Eigen::Vector3f& point) const {
  const auto pixel = camera_.PixelOf(point);
  if (!pixel) return false;
  const float seen = view.depth(pixel->y(), pixel->x());
  // Both are noisy.
  const float tolerance = kOneBody.At(point.z(), camera_.noise) +
                          kNoiseAlone.At(seen, camera_.noise);
  return ClassifyDepth(seen, point.z(), tolerance) == DepthState::kFree;
}

cv::Mat_<uchar> SeenSpace::WasEmpty(const cv::Mat_<uchar>& mask,
                                    const PointMap& points,
                                    const Rigid3d& world_from_camera) const {
  cv::Mat_<uchar> empty(mask.size(), uchar(0));
  const cv::Rect box = cv::boundingRect(mask);
  const Rigid3f world_from_live = world_from_camera.cast<float>();
  std::vector<Rigid3f> view_from_live;
  for (const View& view : views_) {
    view_from_live.push_back(view.camera_from_world * world_from_live);
  }
  tbb::parallel_for(box.y, box.br().y, [&](int v) {
    for (int u = box.x; u < box.br().x; ++u) {
      const cv::Vec3f& p = points.points(v, u);
      if (!mask(v, u) || p[2] <= 0) continue;
      const Eigen::Vector3f point(p[0], p[1], p[2]);
      for (std::size_t i = 0; i < views_.size() && !empty(v, u); ++i) {
        if (LookedThrough(views_[i], view_from_live[i] * point)) {
          empty(v, u) = 255;
        }
      }
    }
  });
  return empty;
}

}  // namespace splitfusion
