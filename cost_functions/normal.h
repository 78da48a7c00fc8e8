#ifndef SPLITFUSION_COST_FUNCTIONS_NORMAL_H_
#define SPLITFUSION_COST_FUNCTIONS_NORMAL_H_

#include <ceres/rotation.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {

/// Difference between the normal of a model point, turned by the warp, and the
/// live normal (Serafin and Grisetti 2015, NICP).
///
///   r = m sqrt(c) [ sum_k w_k exp(omega_k) q_k - n_t ],   q_k = R_k n_v
///
/// n_v is the model normal, canonical, carried by the nodes k with the weights
/// w_k of Eq. 3, n_t the live normal, c the confidence of the depth, m what a
/// radian counts for, metres: normals that are apart by the angle a differ by
/// 2 sin(a / 2), which is a where a is small. The sum is as long as a normal
/// where the nodes agree, and is left shorter where they do not.
///
/// Blocks: the twists of the nodes that carry the point. Residual: 3, metres *
/// sqrt(confidence). Unchanged by any translation, and by turns about the normal.
struct NormalDifference {
  /// Residuals of one point.
  static constexpr int kResiduals = 3;  // Layout.
  int count = 0;                        ///< Nodes that carry it.
  /// w_k q_k, camera frame.
  std::array<Eigen::Vector3d, kMaxSkinningNodes> turned;
  Eigen::Vector3d target;  ///< n_t, camera frame, unit length.
  double factor = 1;       ///< m sqrt(c), metres.

  /// That of a pair about the graph's current motions.
  static NormalDifference Make(const DeformationGraph& graph,
                               const Correspondence& c, double metres) {
    const Skinning& skinning = c.model.skinning;
    NormalDifference made;
    made.count = skinning.count;
    for (int k = 0; k < skinning.count; ++k) {
      made.turned[k] =
          skinning.weights[k] * (graph.motions[skinning.nodes[k]].rotation *
                                 c.model.normal.cast<double>());
    }
    made.target = c.target_normal.cast<double>();
    made.factor = metres * std::sqrt(c.weight);
    return made;
  }

  /// `twists`: of the nodes, in the order of the skinning.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = T(-factor * target[d]);
    for (int k = 0; k < count; ++k) {
      const T q[3] = {T(turned[k].x()), T(turned[k].y()), T(turned[k].z())};
      T moved[3];
      ceres::AngleAxisRotatePoint(twists[k], q, moved);
      for (int d = 0; d < 3; ++d) residual[d] += T(factor) * moved[d];
    }
    return true;
  }
};

/// Differences of normals over all correspondences. As of
/// AddCorrespondenceResiduals(), their mean is weighted by the confidences.
class NormalTerm : public EnergyTerm {
 public:
  void List(OptionList* list) override {
    list->Number("metres", &metres_, Range::Above(0), "metres",
                 "That a radian between the normals counts for.");
  }

  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<std::vector<int>> nodes;
    std::vector<NormalDifference> functors;
    double total = 0;
    for (const Correspondence& c : input.correspondences) {
      const auto first = c.model.skinning.nodes.begin();
      nodes.emplace_back(first, first + c.model.skinning.count);
      functors.push_back(NormalDifference::Make(input.graph, c, metres_));
      total += c.weight;
    }
    sink->AddNodes(nodes, functors, total);
  }

 private:
  double metres_ = 0.05;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_COST_FUNCTIONS_NORMAL_H_
