#ifndef SPLITFUSION_LIB_EXPERIMENT_FIGURES_H_
#define SPLITFUSION_LIB_EXPERIMENT_FIGURES_H_

#include <array>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace splitfusion {

/// Columns of figures in the tables, in their order; all in SI units, shares
/// 0..1.
inline constexpr std::array<const char*, 16> kFigureNames = {
    "frames",
    "lost_frames",
    "ate_m",
    "rpe_m",
    "rpe_deg",
    "tracks_mean_m",
    "tracks_median_m",
    "surface_error_m",
    "f_score_seen",
    "view_error_m",
    "missing",
    "stretched",
    "ghosts",
    "seconds_per_frame",
    "cpu_seconds_per_frame",
    "peak_memory_bytes"};

/// Place of a name in kFigureNames.
std::size_t FigureColumn(const std::string& name);

/// Effect on a figure, by its place in kFigureNames: the natural logarithm of
/// its ratio to that of the baseline, without unit, or, of shares and counts,
/// which may be 0, the difference. Not finite if either is unknown, or 0 in a
/// ratio: DescribeValues() leaves such effects out, and counts those that it
/// takes.
double EffectOn(std::size_t figure, double value, double baseline);

/// Whether the effect is a log ratio.
bool IsRatio(std::size_t figure);

/// Figures of one run, by kFigureNames; NaN where there is none.
struct Figures {
  /// All unknown.
  Figures() { values.fill(std::numeric_limits<double>::quiet_NaN()); }

  std::array<double, kFigureNames.size()> values;  ///< By column.

  /// A figure by its name, one of kFigureNames.
  double& At(const std::string& name) { return values[FigureColumn(name)]; }
  /// The same.
  double At(const std::string& name) const {
    return values[FigureColumn(name)];
  }
};

/// Reads the figures of RUN/summary.json and, if `evaluated`, of the headline
/// of RUN/evaluation.json.
///
/// @throw InputError if one of them is not what the programs write, or not as
///     RUN/run.json says.
Figures ReadFigures(const std::string& run, bool evaluated);

/// An object of the figures that are known.
nlohmann::ordered_json ToJson(const Figures& figures);

/// What ToJson() wrote; figures that are missing or no numbers are unknown.
Figures FiguresFromJson(const nlohmann::ordered_json& json);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_FIGURES_H_
