#include "splitfusion/lib/association/pointwise_association.h"

namespace splitfusion {
namespace {

class ProjectiveAssociator : public PointwiseAssociator {
 public:
  ProjectiveAssociator(const LiveView& live, std::uint16_t surface)
      : PointwiseAssociator(
            live, surface,
            {kOutsideImage, kNoDepth, kOccluded, kOtherSurface, kDepthEdge}) {}

 protected:
  Outcome Find(const Eigen::Vector3f& point, LivePixel* pixel) const override {
    if (!(point.z() > kNearPlane)) return kOutsideImage;
    pixel->place = live_.camera.Project(point);
    const auto nearest = live_.camera.PixelAt(pixel->place);
    if (!nearest) return kOutsideImage;
    const int u = pixel->u = nearest->x(), v = pixel->v = nearest->y();
    const float depth = live_.depth(v, u);
    if (!(depth > 0) || live_.map.normals(v, u)[2] == 0) return kNoDepth;
    if (live_.labels(v, u) != surface_) {
      return ClassifyDepth(depth, point.z(),
                           kNoiseAlone.At(depth, live_.camera.noise)) ==
                     DepthState::kOccluded
                 ? kOccluded
                 : kOtherSurface;
    }
    if (live_.uncertain(v, u) != 0) return kOtherSurface;
    return live_.edges(v, u) != 0 ? kDepthEdge : kAccepted;
  }
};

}  // namespace

std::unique_ptr<Associator> MakeProjectiveAssociator(const LiveView& live,
                                                     std::uint16_t surface) {
  return std::make_unique<ProjectiveAssociator>(live, surface);
}

}  // namespace splitfusion
