#include "splitfusion/lib/experiment/figures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/evaluation/headline.h"
#include "splitfusion/lib/experiment/run_state.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

double NumberAt(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number()
             ? found->get<double>()
             : std::numeric_limits<double>::quiet_NaN();
}

/// The JSON object of a file of a run.
Json ReadObject(const std::string& run, const std::string& name) {
  const std::string path = (fs::path(run) / name).string();
  if (!fs::exists(path)) throw InputError(name + ": missing");
  Json json = ReadVersionedOrNull(path);
  if (!json.is_object()) throw InputError(name + ": expected JSON");
  return json;
}

void ReadSummary(const std::string& run, Figures* figures) {
  const Json summary = ReadObject(run, "summary.json");
  figures->At("frames") = NumberAt(summary, "frames");
  if (!std::isfinite(figures->At("frames"))) {
    throw InputError("summary.json: expected a number 'frames'");
  }
  for (const char* key :
       {"lost_frames", "cpu_seconds_per_frame", "peak_memory_bytes"}) {
    figures->At(key) = NumberAt(summary, key);
  }
  const auto seconds = summary.find("seconds_per_frame");
  if (seconds != summary.end() && seconds->is_object()) {
    figures->At("seconds_per_frame") = NumberAt(*seconds, "median");
  }
}

void ReadHeadline(const std::string& run, Figures* figures) {
  const Json evaluation = ReadObject(run, "evaluation.json");
  const auto headline = evaluation.find("headline");
  if (headline == evaluation.end() || !headline->is_object()) {
    throw InputError("evaluation.json: expected an object 'headline'");
  }
  for (const HeadlineFigure& figure : kHeadlineFigures) {
    figures->At(figure.name) = NumberAt(*headline, figure.name);
  }
}

}  // namespace

std::size_t FigureColumn(const std::string& name) {
  const auto found = std::find(kFigureNames.begin(), kFigureNames.end(), name);
  if (found == kFigureNames.end()) {
    throw std::logic_error(name + " is no figure");
  }
  return static_cast<std::size_t>(found - kFigureNames.begin());
}

bool IsRatio(std::size_t figure) {
  constexpr std::array<std::string_view, 6> kDifferences = {
      "frames",  "lost_frames", "f_score_seen",
      "missing", "stretched",   "ghosts"};
  return std::find(kDifferences.begin(), kDifferences.end(),
                   kFigureNames[figure]) == kDifferences.end();
}

double EffectOn(std::size_t figure, double value, double baseline) {
  return IsRatio(figure) ? std::log(value / baseline) : value - baseline;
}

Figures ReadFigures(const std::string& run, bool evaluated) {
  const std::string damage = FileDamage(ReadRunState(run), run, evaluated);
  if (!damage.empty()) throw InputError(damage);
  Figures figures;
  ReadSummary(run, &figures);
  if (evaluated) ReadHeadline(run, &figures);
  return figures;
}

Json ToJson(const Figures& figures) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
    if (std::isfinite(figures.values[i])) {
      json[kFigureNames[i]] = figures.values[i];
    }
  }
  return json;
}

Figures FiguresFromJson(const Json& json) {
  Figures figures;
  if (!json.is_object()) return figures;
  for (std::size_t i = 0; i < kFigureNames.size(); ++i) {
    figures.values[i] = NumberAt(json, kFigureNames[i]);
  }
  return figures;
}

}  // namespace splitfusion
