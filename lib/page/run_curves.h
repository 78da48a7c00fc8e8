#ifndef SPLITFUSION_LIB_PAGE_RUN_CURVES_H_
#define SPLITFUSION_LIB_PAGE_RUN_CURVES_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "splitfusion/lib/page/svg_chart.h"

namespace splitfusion {

/// Curves of one unit over the frames of a run.
struct CurveGroup {
  std::string name;      ///< Letters, digits and underscores, for files.
  std::string title;     ///< With the unit.
  bool stacked = false;  ///< Parts of a whole.
  std::vector<ChartSeries> series;  ///< Values by position among the frames.
  /// Positions at which a value is no finite number though one was computed: a
  /// cost that diverged.
  std::vector<int> not_finite;
};

/// What is drawn of one surface.
struct SurfaceCurves {
  std::string name;  ///< NNN_LABEL, as its folder.
  /// State by position (`tracked`, `lost`, ...); empty where there is none.
  std::vector<std::string> states;
  std::vector<CurveGroup> groups;  ///< The same of all surfaces.
};

/// Something that happened to a surface in a frame.
struct RunEvent {
  int frame = 0;           ///< Frame index.
  std::string what;        ///< `born`, `revived`, `merged`, `reanchored`, ...
  int surface = 0;         ///< Id; 0: none yet.
  std::string class_name;  ///< Of the surface or detection.
};

/// All curves of a run, from frames.jsonl.
struct RunCurves {
  std::vector<int> frames;  ///< Their indices, ascending.
  /// Decisions that begin or end something, and surfaces that begin anew; in
  /// order of frames.
  std::vector<RunEvent> events;
  CurveGroup seconds;                   ///< Of a frame, by part.
  std::vector<SurfaceCurves> surfaces;  ///< By id.
};

/// Gathers them. `frames`: the lines of frames.jsonl; `surfaces`: of
/// summary.json.
RunCurves GatherCurves(const std::vector<nlohmann::ordered_json>& frames,
                       const nlohmann::ordered_json& surfaces);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_PAGE_RUN_CURVES_H_
