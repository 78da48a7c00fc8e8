#ifndef SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_
#define SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_

#include <map>
#include <string>
#include <vector>

#include "splitfusion/lib/association/association_counts.h"
#include "splitfusion/lib/energy/solver_report.h"
#include "splitfusion/lib/split/surface_splitter.h"

namespace splitfusion {

/// One association followed by one minimisation.
struct TrackingRound {
  std::string stage;  ///< "rigid" or "non_rigid".
  int stride = 1;     ///< Image resolution: every stride-th pixel.
  double prior_factor = 1;  ///< Annealing factor on the prior's weight.
  AssociationCounts association;
  SolverReport solver;
};

/// What happened to one surface in one frame.
struct SurfaceReport {
  int id = 0;  ///< 0 is the background.
  std::string label;
  SurfaceKind kind = SurfaceKind::kRigid;
  /// "tracked", "born", "lost" (a frame that failed; motion kept, nothing
  /// fused) or "unseen" (not in view).
  std::string state;
  std::string reason;  ///< Why lost; empty otherwise.
  int pixels = 0;      ///< Live pixels with depth of this surface.
  int nodes = 0;
  int vertices = 0;
  double residual_rms = 0;  ///< Point-to-plane, last round, metres.
  std::vector<TrackingRound> rounds;
  double render_seconds = 0;
  double associate_seconds = 0;
  double solve_seconds = 0;
  double fuse_seconds = 0;
  double mesh_seconds = 0;
};

/// What happened in one frame.
struct FrameReport {
  int frame = 0;
  double timestamp = 0;
  std::string stem;
  double read_seconds = 0;
  double segment_seconds = 0;
  double split_seconds = 0;
  double render_seconds = 0;
  double associate_seconds = 0;
  double solve_seconds = 0;
  double fuse_seconds = 0;
  double mesh_seconds = 0;
  double total_seconds = 0;  ///< Wall clock, without writing of results.
  std::vector<SplitDecision> decisions;
  std::vector<SurfaceReport> surfaces;  ///< By id; the background first.
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_REPORT_FRAME_REPORT_H_
