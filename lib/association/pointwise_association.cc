#include "splitfusion/lib/association/pointwise_association.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "splitfusion/lib/association/lost_parts.h"
#include "splitfusion/lib/base/median.h"
#include "splitfusion/lib/base/pi.h"
#include "splitfusion/lib/geometry/depth_comparison.h"

namespace splitfusion {
namespace {

/// Takes the median difference of grey values, a change of exposure, out.
void RemoveCommonBrightness(std::vector<Correspondence>* correspondences) {
  std::vector<float> differences;
  differences.reserve(correspondences->size());
  for (const Correspondence& c : *correspondences) {
    differences.push_back(c.intensity_difference);
  }
  const float common = Median(std::move(differences));
  for (Correspondence& c : *correspondences) c.intensity_difference -= common;
}

}  // namespace

/// AssociationGates as they are compared with.
struct PointwiseAssociator::Gates {
  explicit Gates(const AssociationGates& gates)
      : distance(static_cast<float>(gates.distance)),
        normal_angle(static_cast<float>(gates.normal_angle)),
        min_normal_cosine(std::cos(normal_angle)),
        min_view_cosine(static_cast<float>(std::cos(gates.grazing_angle))),
        color_level(gates.coarse_color ? 1 : 0) {}

  float distance;           // Metres.
  float normal_angle;       // Radians between exact normals,
  float min_normal_cosine;  // and its cosine.
  float min_view_cosine;    // Between live normal and view ray.
  int color_level;          // Of LiveView::grey.
};

PointwiseAssociator::PointwiseAssociator(const LiveView& live,
                                         std::uint16_t surface,
                                         std::vector<Outcome> outcomes)
    : live_(live), surface_(surface), outcomes_(std::move(outcomes)) {
  tells_hidden_ = std::count(outcomes_.begin(), outcomes_.end(), kOccluded) > 0;
  outcomes_.insert(outcomes_.end(), {kDistance, kNormalAngle, kGrazing});
}

RejectedPoints PointwiseAssociator::Row(Outcome outcome) {
  switch (outcome) {
    case kOutsideImage:
      return {"outside_image", Rejection::kUntold};
    case kNoDepth:
      return {"no_depth", Rejection::kUntold};
    case kOccluded:
      return {"occluded", Rejection::kOccluded};
    case kOtherSurface:
      return {"other_surface", Rejection::kAbsent};
    case kDepthEdge:
      return {"depth_edge", Rejection::kUntold};
    case kDistance:
      return {"distance", Rejection::kMisfit};
    case kNormalAngle:
      return {"normal_angle", Rejection::kMisfit};
    default:
      return {"grazing", Rejection::kUntold};
  }
}

bool PointwiseAssociator::IsAstray(Outcome outcome) const {
  if (outcome == kAccepted || !tells_hidden_) return false;
  const Rejection kind = Row(outcome).kind;
  return kind == Rejection::kAbsent || kind == Rejection::kMisfit;
}

bool PointwiseAssociator::HaveOneNormal(const Correspondence& pair,
                                        const Gates& gates) const {
  const float cosine = pair.warped_normal.dot(pair.target_normal);
  if (cosine >= gates.min_normal_cosine) return true;
  const float angle =
      gates.normal_angle +
      static_cast<float>(kNoiseSigmas) *
          live_.map.NormalSigma(pair.target.z(), live_.camera.fx);
  return cosine >= std::cos(std::min(angle, kPi<float>));
}

PointwiseAssociator::Outcome PointwiseAssociator::Match(
    const ModelSample& sample, const WarpField& warp, const Gates& gates,
    Correspondence* out) const {
  const Eigen::Vector3f point = warp.WarpPoint(sample.skinning, sample.point);
  LivePixel pixel;
  const Outcome found = Find(point, &pixel);
  if (found != kAccepted) return found;
  const int u = pixel.u, v = pixel.v;
  out->target = ToEigen(live_.map.points(v, u));
  const float gate = std::max(
      gates.distance, kNoiseAlone.At(out->target.z(), live_.camera.noise));
  if ((point - out->target).squaredNorm() > gate * gate) return kDistance;
  out->target_normal = ToEigen(live_.map.normals(v, u));
  out->warped_normal = warp.WarpNormal(sample.skinning, sample.normal);
  if (!HaveOneNormal(*out, gates)) return kNormalAngle;
  if (-out->target_normal.dot(out->target) <
      gates.min_view_cosine * out->target.norm()) {
    return kGrazing;
  }
  out->model = sample;
  out->pixel = pixel.place;
  const GreyLevel& grey = live_.grey[gates.color_level];
  const cv::Vec2f& gradient = grey.gradient(v, u);
  out->intensity_gradient = Eigen::Vector2f(gradient[0], gradient[1]);
  // First-order to the place between the pixels.
  const float live_intensity =
      grey.value(v, u) +
      out->intensity_gradient.dot(
          pixel.place -
          Eigen::Vector2f(static_cast<float>(u), static_cast<float>(v)));
  out->model_intensity = sample.intensity[gates.color_level];
  out->intensity_difference = live_intensity - out->model_intensity;
  out->weight = live_.camera.noise.Confidence(out->target.z());
  return kAccepted;
}

Association PointwiseAssociator::Associate(
    const std::vector<ModelSample>& samples, const WarpField& warp, int stride,
    const AssociationGates& association_gates) const {
  std::vector<const ModelSample*> used;
  for (const ModelSample& sample : samples) {
    if (sample.u % stride == 0 && sample.v % stride == 0) {
      used.push_back(&sample);
    }
  }
  const Gates gates(association_gates);
  std::vector<Outcome> outcomes(used.size());
  // Not set before it is found: setting it takes as long as finding it.
  const std::unique_ptr<Correspondence[]> matches(
      new Correspondence[used.size()]);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, used.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end();
                           ++i) {
                        outcomes[i] = Match(*used[i], warp, gates, &matches[i]);
                      }
                    });
  std::array<int, kGrazing + 1> counts{};
  Association association;
  association.correspondences.reserve(
      std::count(outcomes.begin(), outcomes.end(), kAccepted));
  std::vector<const ModelSample*> astray;
  for (std::size_t i = 0; i < used.size(); ++i) {
    ++counts[outcomes[i]];
    if (IsAstray(outcomes[i])) astray.push_back(used[i]);
    if (outcomes[i] == kAccepted) {
      association.correspondences.push_back(matches[i]);
    }
  }
  if (association_gates.lost_distance > 0) {
    association.lost = PairLostParts(
        FindOpenPoints(live_, surface_, association.correspondences, stride,
                       association_gates),
        astray, warp, association_gates);
  }
  RemoveCommonBrightness(&association.correspondences);
  association.counts.model_points = static_cast<int>(used.size());
  association.counts.accepted = counts[kAccepted];
  for (const Outcome outcome : outcomes_) {
    association.counts.rejected.push_back(Row(outcome));
    association.counts.rejected.back().count = counts[outcome];
  }
  return association;
}

}  // namespace splitfusion
