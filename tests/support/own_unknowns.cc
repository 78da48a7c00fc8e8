#include "support/own_unknowns.h"

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

struct ScaledDistance {
  static constexpr int kResiduals = 3;
  static constexpr int kUnknowns = 1;
  Eigen::Vector3d target;  ///< v_t
  template <typename T>
  bool operator()(const T* x, const T* unknowns, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = x[d] - (T(1) + unknowns[0]) * T(target[d]);
    }
    return true;
  }
};

struct ScalePrior {
  static constexpr int kResiduals = 1;
  static constexpr int kUnknowns = 1;
  template <typename T>
  bool operator()(const T* unknowns, T* residual) const {
    residual[0] = unknowns[0];
    return true;
  }
};

}  // namespace

std::vector<Unknown> DepthScaleTerm::Unknowns() const {
  return {{"scale", "", 0, /*scale=*/0.1}};
}

void DepthScaleTerm::AddResiduals(const EnergyInput& input,
                                  ResidualSink* sink) const {
  std::vector<const ModelSample*> samples;
  std::vector<ScaledDistance> distances;
  for (std::size_t i = 0; i < input.correspondences.size(); i += 5) {
    samples.push_back(&input.correspondences[i].model);
    distances.push_back({input.correspondences[i].target.cast<double>()});
  }
  sink->AddWarpedPoints(samples, distances);
  sink->AddUnknowns(std::vector<ScalePrior>(1));
}

TermRegistry TermsWithDepthScale() {
  TermRegistry terms = BuiltinTerms();
  terms.Register("depth_scale",
                 [] { return std::make_unique<DepthScaleTerm>(); });
  return terms;
}

BrighterSurface::BrighterSurface(const TriangleMesh& mesh, double spacing)
    : graph(spacing > 0 ? CoverWithNodes(mesh, spacing)
                        : MakeRigidGraph(Rigid3d::Identity())) {
  correspondences = PerfectAssociation(
      mesh, graph, [](const Eigen::Vector3d& p) { return Bend(p, 1, 0.5); });
  for (std::size_t i = 0; i < correspondences.size(); ++i) {
    Correspondence& c = correspondences[i];
    const float at = static_cast<float>(i);
    const Eigen::Vector3f& p = c.model.point;
    c.weight = 0.6f + 0.4f * std::sin(at);
    c.pixel = {static_cast<float>(camera.fx * p.x() / p.z() + camera.cx),
               static_cast<float>(camera.fy * p.y() / p.z() + camera.cy)};
    c.model_intensity = 0.5f + 0.4f * std::sin(31 * p.x() + 43 * p.y());
    c.intensity_gradient = {0.02f * std::sin(2 * at), 0.02f * std::cos(3 * at)};
    c.intensity_difference = static_cast<float>(kGain - 1) * c.model_intensity +
                             static_cast<float>(kOffset);
  }
}

SurfaceProblem BrighterSurface::Problem(const Energy& energy) const {
  return {energy, correspondences, camera};
}

Energy EnergyWithUnknowns() {
  return ParseEnergy(
      "point_to_plane(loss=huber) "
      "color(weight=2,exposure=true,loss=huber,scale=0.002) "
      "depth_scale(weight=0.5,loss=cauchy) arap(weight=3)",
      TermsWithDepthScale());
}

}  // namespace splitfusion
