#ifndef SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_
#define SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "splitfusion/lib/association/association_counts.h"
#include "splitfusion/lib/energy/solver_report.h"
#include "splitfusion/lib/segmentation/label_table.h"
#include "splitfusion/lib/split/split_decision.h"
#include "splitfusion/lib/tracking/track_state.h"

namespace splitfusion {

/// One association followed by one minimisation.
struct TrackingRound {
  std::string stage;              ///< "rigid" or "non_rigid".
  int stride = 1;                 ///< Image resolution: every stride-th pixel.
  double anneal = 1;              ///< EnergyInput::anneal.
  AssociationCounts association;  ///< What became of the model points.
  int lost_pairs = 0;             ///< Pairs of Association::lost.
  SolverReport solver;            ///< The minimisation after it.
};

/// How well a solve holds a surface, see NodeCovariance.
struct HoldReport {
  int nodes = 0;            ///< Of the solve.
  int held_by_prior = 0;    ///< Nodes that no data touch.
  double median_sigma = 0;  ///< Of the vertices' deviations, metres.

  /// Saves or restores it, see lib/base/archive.h.
  template <typename Archive>
  void Serialize(Archive* archive) {
    (*archive)(nodes, held_by_prior, median_sigma);
  }
};

/// What happened to one surface in one frame.
struct SurfaceReport {
  int id = 0;                               ///< 0 is the background.
  std::string label;                        ///< Class name.
  SurfaceKind kind = SurfaceKind::kRigid;   ///< How it is tracked.
  TrackState state = TrackState::kTracked;  ///< After this frame.
  /// "born", "reanchored" (its model begins anew), "relocalized" (the camera
  /// was found by landmarks), or empty.
  std::string event;
  bool settled = true;  ///< Whether any rigid stage came to an end.
  /// How badly the model's points in view fit, 0 to 2, each by distance and
  /// grey value: their mean; one that is somewhere else for sure counts 2.
  double misfit = 0;
  std::string reason;       ///< Why tracking failed; empty if it did not.
  double exposure = 1;      ///< Share of the model that nothing hides.
  int pixels = 0;           ///< Live pixels with depth of this surface.
  int nodes = 0;            ///< Of the deformation graph.
  double node_spacing = 0;  ///< Of the graph, metres; 0 if it is rigid.
  int track_points = 0;     ///< Points that were followed into this frame.
  int started_parts = 0;    ///< Parts that started elsewhere, see PartStarter.
  int refuted_nodes = 0;    ///< Nodes whose parts were forgotten.
  int torn_triangles = 0;   ///< That joined what has moved apart.
  int vertices = 0;         ///< Of the mesh.
  double residual_rms = 0;  ///< Point-to-plane, last round, metres.
  std::optional<HoldReport> hold;     ///< If covariances were asked for.
  std::vector<TrackingRound> rounds;  ///< In order of execution.
  double render_seconds = 0;          ///< Rendering of the model.
  double associate_seconds = 0;       ///< Pairs of points.
  double solve_seconds = 0;           ///< Minimisation.
  double fuse_seconds = 0;            ///< Integration into the TSDF.
  double mesh_seconds = 0;            ///< Mesh extraction and graph growth.
};

/// What happened in one frame.
struct FrameReport {
  int frame = 0;                 ///< Frame index, from 0.
  double timestamp = 0;          ///< Of the depth image, seconds.
  std::string stem;              ///< Depth file's name without extension.
  double read_seconds = 0;       ///< Images, and their points and normals.
  double segment_seconds = 0;    ///< Masks from files or a network.
  double split_seconds = 0;      ///< Masks to surfaces.
  double render_seconds = 0;     ///< Rendering of the models.
  double associate_seconds = 0;  ///< Pairs of points.
  double solve_seconds = 0;      ///< Minimisation.
  double fuse_seconds = 0;       ///< Integration into the TSDFs.
  double mesh_seconds = 0;       ///< Mesh extraction and graph growth.
  double total_seconds = 0;      ///< Wall clock, without writing of results.
  std::vector<SplitDecision> decisions;  ///< Of the surface splitter.
  std::vector<SurfaceReport> surfaces;   ///< By id; the background first.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_
