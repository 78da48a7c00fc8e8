#include "splitfusion/lib/association/projective_association.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// What became of one sample; the order is that of the tests.
enum class Outcome : std::uint8_t {
  kAccepted,
  kOutsideImage,
  kNoDepth,
  kOccluded,
  kOtherSurface,
  kDepthEdge,
  kDistance,
  kNormalAngle,
  kGrazing,
};

/// Distances up to so many sigma of the depth noise pass the gate.
constexpr DepthTolerance<float> kNoise = {0, 3};

Eigen::Vector3f ToEigen(const cv::Vec3f& v) { return {v[0], v[1], v[2]}; }

class Associator {
 public:
  Associator(const WarpField& warp, const LiveView& live, std::uint16_t surface,
             const AssociationGates& gates)
      : warp_(warp),
        live_(live),
        surface_(surface),
        distance_(static_cast<float>(gates.distance)),
        min_normal_cosine_(static_cast<float>(std::cos(gates.normal_angle))),
        min_view_cosine_(static_cast<float>(std::cos(gates.grazing_angle))),
        color_level_(gates.coarse_color ? 1 : 0) {}

  Outcome Match(const ModelSample& sample, Correspondence* out) const {
    const Eigen::Vector3f point =
        warp_.WarpPoint(sample.skinning, sample.point);
    if (!(point.z() > 0.05f)) return Outcome::kOutsideImage;
    const Eigen::Vector2f pixel = live_.camera.Project(point);
    const int u = static_cast<int>(std::lround(pixel.x()));
    const int v = static_cast<int>(std::lround(pixel.y()));
    if (u < 0 || v < 0 || u >= live_.camera.width || v >= live_.camera.height) {
      return Outcome::kOutsideImage;
    }
    const cv::Vec3f& normal_pixel = live_.map.normals(v, u);
    if (!(live_.depth(v, u) > 0) || normal_pixel[2] == 0) {
      return Outcome::kNoDepth;
    }
    if (live_.labels(v, u) != surface_ || live_.uncertain(v, u) != 0) {
      const float depth = live_.depth(v, u);
      return live_.labels(v, u) != surface_ &&
                     ClassifyDepth(depth, point.z(), kNoise.At(depth)) ==
                         DepthState::kOccluded
                 ? Outcome::kOccluded
                 : Outcome::kOtherSurface;
    }
    if (live_.edges(v, u) != 0) return Outcome::kDepthEdge;
    out->target = ToEigen(live_.map.points(v, u));
    const float gate = std::max(distance_, kNoise.At(out->target.z()));
    if ((point - out->target).squaredNorm() > gate * gate) {
      return Outcome::kDistance;
    }
    out->target_normal = ToEigen(normal_pixel);
    out->warped_normal = warp_.WarpNormal(sample.skinning, sample.normal);
    if (out->warped_normal.dot(out->target_normal) < min_normal_cosine_) {
      return Outcome::kNormalAngle;
    }
    if (-out->target_normal.dot(out->target) <
        min_view_cosine_ * out->target.norm()) {
      return Outcome::kGrazing;
    }
    out->model = sample;
    out->pixel = pixel;
    const GreyLevel& grey = live_.grey[color_level_];
    const cv::Vec2f& gradient = grey.gradient(v, u);
    out->intensity_gradient = Eigen::Vector2f(gradient[0], gradient[1]);
    // First-order to the place between the pixels.
    const float live_intensity =
        grey.value(v, u) + out->intensity_gradient.dot(
                               pixel - Eigen::Vector2f(static_cast<float>(u),
                                                       static_cast<float>(v)));
    out->intensity_difference = live_intensity - sample.intensity[color_level_];
    out->weight = DepthConfidence(out->target.z());
    return Outcome::kAccepted;
  }

 private:
  const WarpField& warp_;
  const LiveView& live_;
  std::uint16_t surface_;
  float distance_, min_normal_cosine_, min_view_cosine_;
  int color_level_;
};

/// Takes the median difference of grey values, a change of exposure, out.
void RemoveCommonBrightness(std::vector<Correspondence>* correspondences) {
  if (correspondences->empty()) return;
  std::vector<float> differences;
  differences.reserve(correspondences->size());
  for (const Correspondence& c : *correspondences) {
    differences.push_back(c.intensity_difference);
  }
  const auto middle = differences.begin() + differences.size() / 2;
  std::nth_element(differences.begin(), middle, differences.end());
  for (Correspondence& c : *correspondences) c.intensity_difference -= *middle;
}

void Count(Outcome outcome, AssociationCounts* counts) {
  ++counts->model_points;
  switch (outcome) {
    case Outcome::kAccepted:
      ++counts->accepted;
      break;
    case Outcome::kOutsideImage:
      ++counts->outside_image;
      break;
    case Outcome::kNoDepth:
      ++counts->no_depth;
      break;
    case Outcome::kOccluded:
      ++counts->occluded;
      break;
    case Outcome::kOtherSurface:
      ++counts->other_surface;
      break;
    case Outcome::kDepthEdge:
      ++counts->depth_edge;
      break;
    case Outcome::kDistance:
      ++counts->distance;
      break;
    case Outcome::kNormalAngle:
      ++counts->normal_angle;
      break;
    case Outcome::kGrazing:
      ++counts->grazing;
      break;
  }
}

}  // namespace

Association Associate(const std::vector<ModelSample>& samples,
                      const WarpField& warp, const LiveView& live,
                      std::uint16_t surface, int stride,
                      const AssociationGates& gates) {
  std::vector<const ModelSample*> used;
  for (const ModelSample& sample : samples) {
    if (sample.u % stride == 0 && sample.v % stride == 0) {
      used.push_back(&sample);
    }
  }
  const Associator associator(warp, live, surface, gates);
  std::vector<Outcome> outcomes(used.size());
  std::vector<Correspondence> matches(used.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, used.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        outcomes[i] = associator.Match(*used[i], &matches[i]);
                      }
                    });
  Association association;
  std::size_t accepted = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    Count(outcomes[i], &association.counts);
    if (outcomes[i] != Outcome::kAccepted) continue;
    if (accepted < i) matches[accepted] = matches[i];
    ++accepted;
  }
  matches.resize(accepted);
  association.correspondences = std::move(matches);
  RemoveCommonBrightness(&association.correspondences);
  return association;
}

}  // namespace splitfusion
