#include "splitfusion/lib/page/run_curves.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "splitfusion/lib/report/frame_parts.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/// A surface in every frame; null in those in which it was not.
using Appearances = std::vector<const Json*>;

double NumberOrGap(const Json& value) {
  return value.is_number() ? value.get<double>() : kNoValue;
}

const Json* FindSurface(const Json& frame, int id) {
  for (const Json& surface : frame.at("surfaces")) {
    if (surface.at("id") == id) return &surface;
  }
  return nullptr;
}

/// The last round of a surface in a frame; null if there was none.
const Json* LastRound(const Json* surface) {
  if (surface == nullptr || surface->at("rounds").empty()) return nullptr;
  return &surface->at("rounds").back();
}

/// The series of a name, made with gaps if it is new.
std::vector<double>& ValuesOf(const std::string& name, std::size_t count,
                              CurveGroup* group) {
  auto found =
      std::find_if(group->series.begin(), group->series.end(),
                   [&](const ChartSeries& one) { return one.name == name; });
  if (found == group->series.end()) {
    group->series.push_back({name, std::vector<double>(count, kNoValue)});
    found = group->series.end() - 1;
  }
  return found->values;
}

CurveGroup OneCurve(const std::string& name, const std::string& title,
                    const Appearances& surface,
                    const std::function<double(const Json&)>& value) {
  CurveGroup group{name, title, false, {}, {}};
  std::vector<double>& values = ValuesOf(name, surface.size(), &group);
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface[i] != nullptr) values[i] = value(*surface[i]);
  }
  return group;
}

/// Cost by term where the last solve of each frame ended.
CurveGroup Costs(const Appearances& surface) {
  CurveGroup group{"cost", "cost of the last round, by term", true, {}, {}};
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Json* round = LastRound(surface[i]);
    if (round == nullptr || round->at("solver").at("terms").empty()) continue;
    bool finite = round->at("solver").at("final_cost").is_number();
    for (const Json& term : round->at("solver").at("terms")) {
      const double value = NumberOrGap(term.at("final"));
      finite = finite && std::isfinite(value);
      double& sum = ValuesOf(term.at("term").get<std::string>(), surface.size(),
                             &group)[i];
      // A term may be named twice.
      sum = std::isnan(sum) ? value : sum + value;
    }
    if (!finite) group.not_finite.push_back(static_cast<int>(i));
  }
  return group;
}

/// What became of the model points of the last round.
CurveGroup Points(const Appearances& surface) {
  CurveGroup group{"points", "model points of the last round", true, {}, {}};
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Json* round = LastRound(surface[i]);
    if (round == nullptr) continue;
    for (const auto& [reason, count] : round->at("association").items()) {
      if (reason == "model_points") continue;
      ValuesOf(reason, surface.size(), &group)[i] = NumberOrGap(count);
    }
  }
  return group;
}

CurveGroup Seconds(const Appearances& surface) {
  CurveGroup group{"seconds", "seconds", true, {}, {}};
  for (std::size_t i = 0; i < surface.size(); ++i) {
    if (surface[i] == nullptr) continue;
    for (const auto& [part, value] : surface[i]->at("seconds").items()) {
      ValuesOf(part, surface.size(), &group)[i] = NumberOrGap(value);
    }
  }
  return group;
}

double Iterations(const Json& surface) {
  double sum = 0;
  for (const Json& round : surface.at("rounds")) {
    sum += NumberOrGap(round.at("solver").at("iterations"));
  }
  return sum;
}

double ResidualMillimetres(const Json& surface) {
  if (surface.at("rounds").empty()) return kNoValue;
  return 1000 * NumberOrGap(surface.at("residual_rms"));
}

SurfaceCurves CurvesOf(const Json& summary, const std::vector<Json>& frames) {
  SurfaceCurves curves;
  const int id = summary.at("id");
  curves.name = RunPaths::SurfaceName(id, summary.at("label"));
  Appearances surface;
  for (const Json& frame : frames) {
    const Json* found = FindSurface(frame, id);
    surface.push_back(found);
    curves.states.push_back(found == nullptr ? "" : found->at("state"));
  }
  const auto key = [](const char* name) {
    return [name](const Json& one) { return NumberOrGap(one.at(name)); };
  };
  curves.groups = {
      Costs(surface),
      Points(surface),
      OneCurve("residual", "point-to-plane residual, RMS, mm", surface,
               ResidualMillimetres),
      OneCurve("iterations", "iterations of all rounds", surface, Iterations),
      Seconds(surface),
      OneCurve("nodes", "nodes", surface, key("nodes")),
      OneCurve("pixels", "live pixels", surface, key("pixels")),
  };
  return curves;
}

/// What a frame decided and what happened in it, without what goes on as it
/// was: detections of known surfaces, and those that may become one.
void AddEvents(const Json& frame, std::vector<RunEvent>* events) {
  static const std::set<std::string> lasting = {"matched", "missed", "pending",
                                                "ignored"};
  for (const Json& decision : frame.at("decisions")) {
    const std::string action = decision.at("action");
    if (lasting.count(action) > 0) continue;
    events->push_back({frame.at("frame"), action, decision.at("surface"),
                       decision.at("class_name")});
  }
  for (const Json& surface : frame.at("surfaces")) {
    const std::string event = surface.at("event");
    if (event.empty() || event == "born") continue;  // That is a decision.
    events->push_back(
        {frame.at("frame"), event, surface.at("id"), surface.at("label")});
  }
}

}  // namespace

RunCurves GatherCurves(const std::vector<Json>& frames, const Json& surfaces) {
  RunCurves curves;
  curves.seconds = {"seconds", "seconds of a frame, by part", true, {}, {}};
  for (const FramePart& part : kFrameParts) {
    std::vector<double>& values =
        ValuesOf(part.name, frames.size(), &curves.seconds);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      values[i] = NumberOrGap(frames[i].at("seconds").at(part.name));
    }
  }
  for (const Json& frame : frames) {
    curves.frames.push_back(frame.at("frame"));
    AddEvents(frame, &curves.events);
  }
  for (const Json& surface : surfaces) {
    curves.surfaces.push_back(CurvesOf(surface, frames));
  }
  return curves;
}

}  // namespace splitfusion
