#include "support/custom_energy.h"

#include <memory>
#include <vector>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {
namespace {

/// A term of one's own over points: where every fifth should be, metres.
struct Anchor {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d place;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d] - T(place[d]);
    return true;
  }
};

/// And one over node triples: the middle stays between the others.
struct Straight {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d bend;  ///< Of the centres, metres.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(bend[d]) + twists[0][3 + d] -
                    T(0.5) * (twists[1][3 + d] + twists[2][3 + d]);
    }
    return true;
  }
};

class CustomTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    std::vector<const ModelSample*> samples;
    std::vector<Anchor> anchors;
    for (std::size_t i = 0; i < input.correspondences.size(); i += 5) {
      samples.push_back(&input.correspondences[i].model);
      anchors.push_back({input.correspondences[i].target.cast<double>()});
    }
    sink->AddWarpedPoints(samples, anchors);
    std::vector<std::vector<int>> nodes;
    std::vector<Straight> bends;
    const auto center = [&](int i) -> Eigen::Vector3d {
      return input.graph.positions[i] + input.graph.motions[i].translation;
    };
    for (int i = 2; i < input.graph.size(); ++i) {
      nodes.push_back({i - 1, i, i - 2});
      bends.push_back({center(i - 1) - 0.5 * (center(i) + center(i - 2))});
    }
    sink->AddNodes(nodes, bends);
  }
};

}  // namespace

Energy EnergyWithCustomTerm() {
  TermRegistry terms = BuiltinTerms();
  terms.Register("custom", [] { return std::make_unique<CustomTerm>(); });
  return ParseEnergy(
      "point_to_plane(loss=huber) arap(weight=3) "
      "custom(weight=0.01,loss=cauchy,scale=0.05)",
      terms);
}

}  // namespace splitfusion
