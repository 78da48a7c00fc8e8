#ifndef SPLITFUSION_LIB_ENERGY_ENERGY_TERM_H_
#define SPLITFUSION_LIB_ENERGY_ENERGY_TERM_H_

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/association/correspondence.h"
#include "splitfusion/lib/deformation/deformation_graph.h"
#include "splitfusion/lib/energy/residual_sink.h"
#include "splitfusion/lib/energy/term_context.h"
#include "splitfusion/lib/energy/term_state.h"
#include "splitfusion/lib/energy/unknown.h"
#include "splitfusion/lib/geometry/camera.h"

namespace splitfusion {

class OptionList;
struct LinksInTime;
struct LiveView;

/// What a term may look at: one surface at one association.
struct EnergyInput {
  const DeformationGraph& graph;  ///< Motions are the linearisation point.
  /// Pairs of model and live points of the surface.
  const std::vector<Correspondence>& correspondences;
  const PinholeCamera& camera;  ///< Live camera.
  /// The live frame, for terms that look beyond the correspondences; null where
  /// a problem is solved without one.
  const LiveView* live = nullptr;
  /// Where the graph's nodes were in the frame before, one motion a node: their
  /// last motions as the live camera would see them had the surface stood still
  /// in the world (of the background: had the camera stood still). In rigid
  /// rounds one node carries the whole surface from where tracking starts, and
  /// this is its way back. Of a surface that was lost and found elsewhere in
  /// this frame: where it was found. Null where a problem is solved without
  /// history.
  const std::vector<NodeMotion>* before = nullptr;
  /// Falls from TrackerOptions::prior_anneal to 1 over the rounds of a frame,
  /// for terms that begin stiff; nothing is scaled by it but by a term itself.
  double anneal = 1;
  /// Pairs of what the correspondences leave over, see Association::lost; null
  /// where a problem is solved without them.
  const std::vector<Correspondence>* lost = nullptr;
  /// Model points and where point tracks have followed them to, see
  /// PointTracks; null where a problem is solved without them.
  const std::vector<TrackedPoint>* tracks = nullptr;
  int surface = 0;  ///< Id; 0 = background.
  /// Frame, surface, model and round; what is null in it is not known.
  TermContext context = {};
  /// Name, weight and loss of the term that is asked; null where none is.
  const TermOptions* options = nullptr;
  /// What the term that is asked keeps of the surface; null if that is nothing.
  const TermState* state = nullptr;
  /// Values at which the unknowns of the term that is asked began the frame, as
  /// for a prior that lets them walk; null where that is not known.
  const std::vector<double>* begun = nullptr;
  /// What ties the nodes of several frames together; null but where motions of
  /// what was hidden are sought.
  const LinksInTime* links = nullptr;
};

/// One term of the energy (SplitFusion Eq. 4).
///
/// A term adds residual vectors in metres (or units that compare with 1 cm) to
/// the sink and names graph nodes, never parameter memory. The sink scales
/// them: E_term = weight * (1/N) * sum of rho(|r|^2 / s^2), s = 1 cm, N = the
/// number of residual vectors or the sum of the weights they carry. A new
/// term is one header with a functor and this class, and one line of
/// registration; see examples/ and CONTRIBUTING.md.
class EnergyTerm {
 public:
  virtual ~EnergyTerm() = default;

  /// Adds the term's own parameters: names, ranges, units and meaning of its
  /// fields, whose values in a new term are the defaults. They become keys of
  /// the term in --terms and --set, beside weight, loss and scale. Called
  /// often: it lists, and changes nothing.
  virtual void List(OptionList* /*list*/) {}

  /// What the term estimates beside the motions, at its parameters of now; most
  /// terms nothing. Functors with kUnknowns see the values in this order. They
  /// are estimated for each surface and frame: they begin as Unknown::start
  /// says, and every solve of the frame begins where the one before left them.
  /// One that no residual depends on stays where it begins; a prior is a
  /// residual of the term's own, see ResidualSink::AddUnknowns().
  virtual std::vector<Unknown> Unknowns() const { return {}; }

  /// Adds the residuals of all its points, nodes or edges.
  virtual void AddResiduals(const EnergyInput& input,
                            ResidualSink* sink) const = 0;

  /// Makes what the term keeps of a surface whose model begins: what is costly
  /// and the same in all rounds of a frame, or goes on from frame to frame.
  /// Null: nothing. AddResiduals() gets it as EnergyInput::state.
  virtual std::unique_ptr<TermState> NewState() const { return nullptr; }

  /// Brings the state of a surface up to a frame, before the first round. The
  /// graph is the surface's own, as it is predicted; there are neither
  /// correspondences nor EnergyInput::before yet. A surface that is looked for
  /// a second time in a frame, elsewhere, is prepared a second time, with the
  /// same FrameFacts::index. Surfaces are prepared on several threads.
  virtual void Prepare(const EnergyInput& /*input*/,
                       TermState* /*state*/) const {}
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_ENERGY_TERM_H_
