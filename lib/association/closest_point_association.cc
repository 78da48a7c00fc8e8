#include <optional>

#include "splitfusion/lib/association/pointwise_association.h"
#include "splitfusion/lib/geometry/nearest_point.h"

namespace splitfusion {
namespace {

class ClosestPointAssociator : public PointwiseAssociator {
 public:
  ClosestPointAssociator(const LiveView& live, std::uint16_t surface)
      : PointwiseAssociator(live, surface, {kNoDepth}) {
    std::vector<Eigen::Vector3f> points;
    for (int v = 0; v < live.depth.rows; ++v) {
      for (int u = 0; u < live.depth.cols; ++u) {
        if (!IsCertain(live, surface, v, u) || live.map.normals(v, u)[2] == 0) {
          continue;
        }
        const cv::Vec3f& p = live.map.points(v, u);
        points.emplace_back(p[0], p[1], p[2]);
        pixels_.push_back(
            {u, v, {static_cast<float>(u), static_cast<float>(v)}});
      }
    }
    if (!points.empty()) tree_.emplace(points);
  }

 protected:
  Outcome Find(const Eigen::Vector3f& point, LivePixel* pixel) const override {
    if (!tree_) return kNoDepth;
    *pixel = pixels_[tree_->Find(point, /*hint=*/-1, nullptr)];
    return kAccepted;
  }

 private:
  std::vector<LivePixel> pixels_;
  std::optional<NearestPoint> tree_;  // Of the points of pixels_.
};

}  // namespace

std::unique_ptr<Associator> MakeClosestPointAssociator(const LiveView& live,
                                                       std::uint16_t surface) {
  return std::make_unique<ClosestPointAssociator>(live, surface);
}

}  // namespace splitfusion
