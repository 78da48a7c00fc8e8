#ifndef SPLITFUSION_TESTS_SUPPORT_OWN_UNKNOWNS_H_
#define SPLITFUSION_TESTS_SUPPORT_OWN_UNKNOWNS_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/energy/solver.h"
#include "splitfusion/lib/geometry/triangle_mesh.h"

namespace splitfusion {

/// Every fifth point is where it should be, but for the scale of the sensor's
/// depth, which is estimated: r = x - (1 + k) v_t, and a prior on k.
class DepthScaleTerm : public EnergyTerm {
 public:
  std::vector<Unknown> Unknowns() const override;
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override;
};

/// Built-in terms and "depth_scale".
TermRegistry TermsWithDepthScale();

/// A surface that is bent and seen brighter than its model.
struct BrighterSurface {
  /// Over `mesh`; `spacing` of the nodes in metres, 0: one node.
  BrighterSurface(const TriangleMesh& mesh, double spacing);

  /// The problem of an energy, which must outlive it, as the surface.
  SurfaceProblem Problem(const Energy& energy) const;

  static constexpr double kGain = 1.15;     ///< Of the live image.
  static constexpr double kOffset = -0.04;  ///< Likewise.

  PinholeCamera camera{640, 480, 525, 525, 319.5, 239.5};
  DeformationGraph graph;
  std::vector<Correspondence> correspondences;
};

/// Point-to-plane, colour with gain and offset, depth scale, and ARAP.
Energy EnergyWithUnknowns();

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_OWN_UNKNOWNS_H_
