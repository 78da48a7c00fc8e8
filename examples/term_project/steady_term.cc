// A term over three frames, in one file, as a shared library:
//   sf_run --terms_library=libsteady.so --set="person.terms.steady.weight=4"
//   ...

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "splitfusion/lib/base/option_list.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/surface_history.h"
#include "splitfusion/lib/energy/terms_library.h"

namespace {

using splitfusion::EnergyInput;
using splitfusion::FrameMotions;
using splitfusion::NodeMotion;
using splitfusion::SurfaceHistory;

/// Acceleration of a node's centre c = g + t.
///
///   r = (c + tau) - 2 c_1 + c_2
///
/// c_1 and c_2: one and two frames before, as the live camera would see them;
/// tau: what is sought. Residual: 3, metres a frame squared.
struct Acceleration {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d so_far;  ///< r at tau = 0.

  /// `twists`: of the node, [omega (rad), tau (m)].
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = T(so_far[d]) + twists[0][3 + d];
    return true;
  }
};

/// Accelerations of all nodes, unless they are larger than `most`: what is so
/// fast was meant.
class SteadyTerm : public splitfusion::EnergyTerm {
 public:
  void List(splitfusion::OptionList* list) override {
    list->Number("most", &most_, splitfusion::Range::Above(0), "metres",
                 "Nodes that speed up by more in a frame are left alone.");
  }

  void AddResiduals(const EnergyInput& input,
                    splitfusion::ResidualSink* sink) const override {
    const SurfaceHistory* history = input.context.history;
    // In rigid rounds the one node is no point of the surface.
    if (history == nullptr || input.graph.rigid()) return;
    for (int back : {1, 2}) {
      const auto frame = history->Find(back);
      if (!frame || !frame->tracked) return;
    }
    const std::vector<NodeMotion> one = history->Before(1);
    const std::vector<NodeMotion> two = history->Before(2);
    if (one.empty() || two.empty()) return;
    std::vector<std::vector<int>> nodes;
    std::vector<Acceleration> residuals;
    for (int i = 0; i < input.graph.size(); ++i) {
      const Eigen::Vector3d so_far = input.graph.motions[i].translation -
                                     2 * one[i].translation +
                                     two[i].translation;
      if (so_far.norm() > most_) continue;
      nodes.push_back({i});
      residuals.push_back({so_far});
    }
    sink->AddNodes(nodes, residuals);
  }

 private:
  double most_ = 0.05;
};

void AddTerms(splitfusion::TermRegistry* terms) {
  terms->Register("steady", [] { return std::make_unique<SteadyTerm>(); });
}

}  // namespace

SPLITFUSION_TERMS_LIBRARY(AddTerms)
