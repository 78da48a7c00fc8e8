#ifndef SPLITFUSION_COST_FUNCTIONS_POINT_TO_TSDF_H_
#define SPLITFUSION_COST_FUNCTIONS_POINT_TO_TSDF_H_

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <vector>

#include "splitfusion/cost_functions/point_to_plane.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/tsdf/sample_distance.h"
#include "splitfusion/lib/tsdf/tsdf_volume.h"

namespace splitfusion {

/// Signed distances of live points from the model's volume (Bylow et al. 2013,
/// for cameras), where the warp takes them back to:
///
///   r = sqrt(c) phi(y) / |grad phi|,   W(y) = v_t
///
/// v_t is the live point of a pair, c the confidence of its depth, phi the
/// signed distance in the canonical frame. With the nodes and weights of the
/// pair's model point v held, the warp is affine,
///
///   W(p) = x + B (p - v),   x = W(v),   B = sum_k w_k R_k,
///
/// so that y = v + B^-1 (v_t - x) at the association. When nodes move, W(y)
/// leaves v_t, and what is at v_t moves the other way; phi is taken for linear
/// about y:
///
///   r ~ sqrt(c) [ phi(y) - n . (W(y) - v_t) ] / |n|,   n = B^-T grad phi.
///
/// That is Eq. 5 for the point W(y), with the plane that the volume has there,
/// up to the sign. Distances are measured along view rays, which makes them and
/// their gradient longer than they are across the surface: hence |n|.
///
/// Pairs whose place is unobserved or beyond the truncation add nothing.
/// Absent where the volume is not known, and in rigid rounds of a surface that
/// deforms, which have lost the canonical places. Residual: 1, metres *
/// sqrt(confidence).
class PointToTsdfTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    const std::optional<Rigid3d> canonical = CanonicalFromSamples(input);
    if (!canonical) return;
    std::vector<ModelSample> places;
    std::vector<PointToPlane> functors;
    double total = 0;
    const WarpField warp(input.graph);
    for (const Correspondence& c : input.correspondences) {
      ModelSample place = c.model;
      if (!AddPair(input, *canonical, warp, c, &place, &functors)) continue;
      places.push_back(place);
      total += c.weight;
    }
    std::vector<const ModelSample*> samples;
    for (const ModelSample& place : places) samples.push_back(&place);
    sink->AddWarpedPoints(samples, functors, total);
  }

 private:
  /// From where samples are, which rigid rounds carry from the camera frame.
  static std::optional<Rigid3d> CanonicalFromSamples(const EnergyInput& input) {
    const TermContext& context = input.context;
    if (context.surface == nullptr || context.surface->volume == nullptr) {
      return std::nullopt;
    }
    if (!context.round.rigid) return Rigid3d::Identity();
    const DeformationGraph* start = context.surface_graph;
    if (start == nullptr || !start->rigid()) return std::nullopt;
    return MeanRigidMotion(*start).inverse();
  }

  static Eigen::Matrix3d Blend(const DeformationGraph& graph,
                               const Skinning& skinning) {
    Eigen::Matrix3d blend = Eigen::Matrix3d::Zero();
    for (int k = 0; k < skinning.count; ++k) {
      blend += skinning.weights[k] * graph.motions[skinning.nodes[k]].rotation;
    }
    return blend;
  }

  /// Puts `place` to y; false if the volume has no distance there.
  static bool AddPair(const EnergyInput& input, const Rigid3d& canonical,
                      const WarpField& warp, const Correspondence& c,
                      ModelSample* place, std::vector<PointToPlane>* functors) {
    Eigen::Matrix3d back;  // B^-1
    bool invertible = false;
    Blend(input.graph, place->skinning)
        .computeInverseWithCheck(back, invertible);
    if (!invertible) return false;
    const Eigen::Vector3f way =
        c.target - warp.WarpPoint(place->skinning, place->point);
    place->point += (back * way.cast<double>()).cast<float>();
    const TsdfVolume& volume = *input.context.surface->volume;
    const std::optional<DistanceSample> sample =
        SampleDistance(volume, canonical * place->point.cast<double>());
    if (!sample || std::abs(sample->distance) >= volume.options().truncation ||
        sample->gradient.isZero()) {
      return false;
    }
    const Eigen::Vector3d n =
        back.transpose() * (canonical.linear().transpose() * sample->gradient);
    const Eigen::Vector3d unit = n.normalized();
    functors->push_back(
        {unit, c.target.cast<double>() + sample->distance / n.norm() * unit,
         std::sqrt(c.weight)});
    return true;
  }
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_POINT_TO_TSDF_H_
