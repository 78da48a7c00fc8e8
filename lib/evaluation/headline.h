#ifndef SPLITFUSION_LIB_EVALUATION_HEADLINE_H_
#define SPLITFUSION_LIB_EVALUATION_HEADLINE_H_

#include <array>
#include <optional>

namespace splitfusion {

struct RunEvaluation;

/// The figures of a run that tables of many runs show. Those of instances are
/// plain means over the instances that have them, people and whatever else
/// deforms: rigid ones do not count. Empty = not known.
struct Headline {
  std::optional<double> ate_m;            ///< RMSE.
  std::optional<double> rpe_m;            ///< Over one frame, RMSE.
  std::optional<double> rpe_deg;          ///< The same, degrees.
  std::optional<double> tracks_mean_m;    ///< Visible points.
  std::optional<double> tracks_median_m;  ///< Visible points.
  std::optional<double> surface_error_m;  ///< Mean accuracy of instances.
  std::optional<double> f_score_seen;     ///< 0..1.
  std::optional<double> view_error_m;     ///< Mean view error of instances.
  std::optional<double> missing;          ///< 0..1, ViewError::MissingShare().
  /// 0..1, of the surfaces matched to instances; without truth, of all surfaces
  /// but the background.
  std::optional<double> stretched;
  std::optional<double> ghosts;  ///< 0..1, of the background's vertices.
};

/// A member of Headline under its name in evaluation.json.
struct HeadlineFigure {
  const char* name;                        ///< Key.
  std::optional<double> Headline::*value;  ///< Member.
};

/// All of them, in the order in which they are shown.
constexpr std::array<HeadlineFigure, 11> kHeadlineFigures = {{
    {"ate_m", &Headline::ate_m},
    {"rpe_m", &Headline::rpe_m},
    {"rpe_deg", &Headline::rpe_deg},
    {"tracks_mean_m", &Headline::tracks_mean_m},
    {"tracks_median_m", &Headline::tracks_median_m},
    {"surface_error_m", &Headline::surface_error_m},
    {"f_score_seen", &Headline::f_score_seen},
    {"view_error_m", &Headline::view_error_m},
    {"missing", &Headline::missing},
    {"stretched", &Headline::stretched},
    {"ghosts", &Headline::ghosts},
}};

/// The headline of an evaluation.
Headline HeadlineOf(const RunEvaluation& evaluation);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_HEADLINE_H_
