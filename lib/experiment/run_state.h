#ifndef SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_
#define SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_

#include <optional>
#include <string>

#include "splitfusion/lib/report/run_marker.h"

namespace splitfusion {

/// What a run directory says of itself, however damaged it is.
struct RunState {
  std::optional<RunMarker>
      marker;          ///< Empty if there is none, or a broken one.
  std::string damage;  ///< What is wrong with the marker.

  /// Whether the run has succeeded.
  bool IsComplete() const {
    return marker && marker->status == RunStatus::kComplete;
  }
  /// Id of the run; empty if it is unknown.
  std::string Id() const { return marker ? marker->id : ""; }
  /// Whether there is a marker, of whatever kind.
  bool Exists() const { return marker || !damage.empty(); }
};

/// Reads RUN/run.json.
RunState ReadRunState(const std::string& run);

/// Why a run is not as it was written: summary.json or, if `evaluated`,
/// evaluation.json has another content, or any file but the evaluation is
/// missing or has another size; empty if there is nothing against it.
std::string FileDamage(const RunState& state, const std::string& run,
                       bool evaluated);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RUN_STATE_H_
