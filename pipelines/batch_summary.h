#ifndef SPLITFUSION_PIPELINES_BATCH_SUMMARY_H_
#define SPLITFUSION_PIPELINES_BATCH_SUMMARY_H_

#include <array>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "splitfusion/pipelines/batch_plan.h"

namespace splitfusion {

/// Figures of one run; NaN where there is none.
struct BatchFigures {
  /// Value of a figure that is not known.
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  double frames = kNone;       ///< Frames processed.
  double lost_frames = kNone;  ///< Frames in which a surface was lost.
  double ate_rmse_m = kNone;   ///< Aligned trajectory error, metres.
  /// Mean distance of the background's mesh to the true one, metres.
  double background_accuracy_m = kNone;
  /// Fraction of the true background that has a mesh within 20 mm.
  double background_completeness = kNone;
  /// Mean view error over the pixels with a model, metres; this and the next
  /// three are means over the moving instances that have the figure.
  double objects_view_m = kNone;
  /// Fraction of the pixels at which the model is within 20 mm.
  double objects_right = kNone;
  /// Fraction of the pixels of moving instances at which there is no model.
  double objects_uncovered = kNone;
  /// Mean distance of an instance's mesh to the true one, metres.
  double objects_accuracy_m = kNone;
  /// F-score of an instance's mesh at 20 mm, over the same frames.
  double objects_f_score = kNone;
  double track_median_m = kNone;     ///< Of visible surface points, metres.
  double track_mean_m = kNone;       ///< Of visible surface points, metres.
  double seconds_median = kNone;     ///< Per frame.
  double seconds_mean = kNone;       ///< Per frame.
  double peak_memory_bytes = kNone;  ///< Largest resident size.
};

/// One column of figures in the files and the table of a batch.
struct BatchColumn {
  const char* name;              ///< Key in the files.
  double BatchFigures::*figure;  ///< Where the value is.
};

/// The figures in the order of the files.
inline constexpr std::array<BatchColumn, 15> kBatchColumns = {{
    {"frames", &BatchFigures::frames},
    {"lost_frames", &BatchFigures::lost_frames},
    {"ate_rmse_m", &BatchFigures::ate_rmse_m},
    {"background_accuracy_m", &BatchFigures::background_accuracy_m},
    {"background_completeness", &BatchFigures::background_completeness},
    {"objects_view_m", &BatchFigures::objects_view_m},
    {"objects_right", &BatchFigures::objects_right},
    {"objects_uncovered", &BatchFigures::objects_uncovered},
    {"objects_accuracy_m", &BatchFigures::objects_accuracy_m},
    {"objects_f_score", &BatchFigures::objects_f_score},
    {"track_median_m", &BatchFigures::track_median_m},
    {"track_mean_m", &BatchFigures::track_mean_m},
    {"seconds_median", &BatchFigures::seconds_median},
    {"seconds_mean", &BatchFigures::seconds_mean},
    {"peak_memory_bytes", &BatchFigures::peak_memory_bytes},
}};

/// What became of one run of a batch.
struct BatchResult {
  BatchRun run;          ///< What was to be done.
  bool skipped = false;  ///< Had been finished before.
  int exit_code = 0;     ///< Of sf_run, or of sf_evaluate if that failed.
  std::string error;     ///< Last line on stderr of what failed.
  BatchFigures figures;  ///< From summary.json and evaluation.json.
};

/// Reads the figures of a run directory; files or keys that are missing leave
/// NaN.
BatchFigures ReadFigures(const std::string& run_folder);

/// Value of `summary.json` of a batch: an array with one object a run.
nlohmann::ordered_json ToJson(const std::vector<BatchResult>& results);

/// Writes FOLDER/summary.csv and FOLDER/summary.json.
///
/// @throw InputError if a file cannot be written.
void WriteBatchSummary(const std::string& folder,
                       const std::vector<BatchResult>& results);

/// The results as a table for the terminal, one line a run.
std::string FormatBatchTable(const std::vector<BatchResult>& results);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_BATCH_SUMMARY_H_
