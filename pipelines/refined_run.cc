#include "splitfusion/pipelines/refined_run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/deformation/motion_file.h"
#include "splitfusion/lib/page/html_report.h"
#include "splitfusion/lib/report/run_summary.h"
#include "splitfusion/lib/report/surface_output.h"
#include "splitfusion/pipelines/refine_pass.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Whether a file of the run is written anew, or is no more than what it was
/// made from: checkpoints and residuals are of the motions as they were.
bool IsWrittenAnew(const std::string& path) {
  const RunPaths here("");
  const fs::path file(path);
  const std::string first = file.begin()->string();
  return path == here.Refinement() || path == here.HiddenDeviations() ||
         path == here.Summary() || path == here.HtmlReport() ||
         path == here.Options() || path == here.Evaluation() ||
         first == "checkpoints" || file.filename() == "motions.bin" ||
         file.filename() == "residuals.h5" ||
         file.parent_path().filename() == "warped" ||
         (first == "problems" &&
          file.filename().string().find("_hidden_") != std::string::npos);
}

/// The options by the names that they have as flags.
std::map<std::string, std::string> ValuesOf(HiddenMotionOptions options) {
  options.refine = true;
  OptionList list;
  options.List(&list);
  std::map<std::string, std::string> values;
  for (const Option& option : list.options()) {
    values[option.name] = option.ValueText();
  }
  return values;
}

std::map<int, Rigid3d> PosesOf(const RecordedRun& run) {
  std::map<int, Rigid3d> poses;
  for (const RecordedFrame& frame : run.frames) {
    poses[frame.index] = frame.pose.world_from_camera;
  }
  return poses;
}

/// The warped meshes that the run has.
///
/// @throw InputError if its marker does not say.
WarpedOutput WarpedOf(const std::string& root, const RunMarker& marker) {
  const NamedValues& outputs = marker.identity.outputs;
  const auto every = outputs.find("warped_every");
  const auto whole = outputs.find("warped_whole");
  if (every == outputs.end() || whole == outputs.end() ||
      every->second.find_first_not_of("0123456789") != std::string::npos) {
    throw InputError(root +
                     "/run.json: expected outputs warped_every, a number, and "
                     "warped_whole");
  }
  return {std::stoi("0" + every->second.substr(0, 8)), whole->second == "true"};
}

/// @throw InputError if summary.json has not what SummaryWith() looks at.
void CheckSummary(const std::string& root) {
  const std::string path = RunPaths(root).Summary();
  const Json summary = ReadVersionedOrNull(path);
  const auto has = [&](const char* key, auto is) {
    return summary.is_object() && summary.contains(key) && is(summary[key]);
  };
  const bool whole =
      has("frames", [](const Json& v) { return v.is_number(); }) &&
      has("surfaces", [](const Json& v) {
        return v.is_array() && std::all_of(v.begin(), v.end(), [](auto& s) {
                 return s.is_object() && s.contains("id") &&
                        s["id"].is_number();
               });
      });
  if (!whole) {
    throw InputError(path + ": expected 'frames' and 'surfaces' of a run");
  }
}

/// What was refined, over all surfaces.
struct Refinement {
  int hidden = 0;
  RefinementReport report;
  std::map<int, double> stretched;  // By surface, shares.
  double seconds = 0;
};

/// @throw InputError if nothing is known of what was seen.
void CheckSeen(const std::string& root, const RecordedSurface& surface) {
  for (const FrameMotions& frame : surface.motions) {
    if (!frame.seen.empty()) return;
  }
  throw InputError(root + ": motions.bin of surface " +
                   std::to_string(surface.id) +
                   " does not say which nodes were seen: expected a run of "
                   "this version of sf_run");
}

/// Writes every n-th of the windows of a surface as a problem of its own.
class WindowFreezer {
 public:
  /// `every`: n; 0: none. `to` must outlive this.
  WindowFreezer(int every, double smoothness, const RunPaths& to)
      : every_(every), smoothness_(smoothness), to_(to) {}

  /// What is told of those of a surface; empty if none is to be written.
  std::function<void(const WindowProblem&)> Of(int surface) {
    if (every_ == 0) return {};
    windows_ = 0;
    return [this, surface](const WindowProblem& window) {
      if (windows_++ % every_ != 0) return;
      const RefinedWindow& report = window.report;
      WriteFrozenProblem(
          to_.HiddenProblem(report.first_frame, surface, report.part),
          FreezeWindow(window, surface, smoothness_));
    };
  }

 private:
  int every_;
  double smoothness_;
  const RunPaths& to_;
  int windows_ = 0;
};

void RefineSurface(const std::map<int, Rigid3d>& poses,
                   const HiddenMotionOptions& options,
                   const WarpedOutput& warped, const RunPaths& to,
                   RecordedSurface surface, WindowFreezer* freezer,
                   Refinement* refinement) {
  SurfaceModel model{std::move(surface.mesh), std::move(surface.graph),
                     std::move(surface.motions)};
  // The camera's motion was measured in every frame.
  const bool is_room = surface.id == 0 && model.graph.rigid();
  if (!is_room) {
    const Stopwatch stopwatch;
    refinement->hidden +=
        RefineAndReport(poses, options, surface.id, &model, &refinement->report,
                        freezer->Of(surface.id));
    refinement->seconds += stopwatch.Seconds();
  }
  WriteMotions(to.Surface(surface.id, surface.label) + "/motions.bin",
               model.history, model.graph.size());
  if (is_room) return;
  const StretchedArea stretch =
      WriteWarpedMeshes(to, surface.id, surface.label, model,
                        surface.neighbors_per_point, warped);
  if (stretch.area > 0) {
    refinement->stretched[surface.id] = stretch.Share();
  }
}

/// summary.json of the run with what is another now.
Json SummaryWith(const Refinement& refinement, Json summary) {
  for (Json& surface : summary["surfaces"]) {
    const auto found = refinement.stretched.find(surface["id"].get<int>());
    if (found != refinement.stretched.end()) {
      surface["stretched"] = found->second;
    }
  }
  const double before = summary.value("seconds_refining", 0.0);
  const double frames = std::max(1, summary["frames"].get<int>());
  const double all = summary.value("seconds_per_frame_all_passes", 0.0);
  summary["seconds_refining"] = refinement.seconds;
  summary["seconds_per_frame_all_passes"] =
      all + (refinement.seconds - before) / frames;
  return summary;
}

}  // namespace

RefinedRun::RefinedRun(std::string root, const HiddenMotionOptions& options,
                       int freeze)
    : root_(std::move(root)), options_(options), freeze_(freeze) {
  CheckOptions(options_);
  const std::optional<RunMarker> marker = ReadRunMarker(root_);
  if (!marker || marker->status != RunStatus::kComplete) {
    throw InputError(root_ + ": holds no complete run: expected one");
  }
  marker_ = *marker;
  const std::string missing = FindMissing(marker_, root_);
  if (!missing.empty()) throw InputError(root_ + ": " + missing);
  for (const auto& [path, file] : marker_.files) {
    // What is copied alone is checked then.
    const fs::path name(path);
    const bool is_read =
        name.parent_path().empty() || name.filename() == "motions.bin" ||
        name.filename() == "graph.json" || name.filename() == "mesh.ply";
    if (is_read) CheckRunFile(marker_, root_, path);
  }
  WarpedOf(root_, marker_);
  CheckSummary(root_);
  run_ = ReadRun(root_);
  for (const RecordedSurface& surface : run_.surfaces) {
    CheckSeen(root_, surface);
  }
}

RunIdentity RefinedRun::Identity() const {
  RunIdentity identity = marker_.identity;
  identity.parts["refined_from"] = marker_.identity.Hash();
  identity.parts["method"] = MethodHash();
  for (const auto& [name, value] : ValuesOf(options_)) {
    identity.parts[name] = value;
  }
  identity.outputs.erase("freeze_hidden");  // Of the run that was refined.
  if (freeze_ > 0) identity.outputs["freeze_hidden"] = std::to_string(freeze_);
  return identity;
}

void RefinedRun::CopyFiles(const RunPaths& to) const {
  for (const auto& [path, file] : marker_.files) {
    if (IsWrittenAnew(path)) continue;
    CheckRunFile(marker_, root_, path);
    const fs::path target = fs::path(to.root()) / path;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    fs::copy_file(fs::path(root_) / path, target,
                  fs::copy_options::overwrite_existing, error);
    if (error) {
      throw InputError(target.string() +
                       ": cannot be written: " + error.message());
    }
  }
}

void RefinedRun::WriteOptions(const RunPaths& to) const {
  auto values = ValuesOf(options_);
  std::ifstream before(RunPaths(root_).Options());
  std::string text;
  for (std::string line; std::getline(before, line);) {
    const std::string flag = line.substr(0, line.find('='));
    const auto found =
        values.find(flag.substr(std::min<std::size_t>(2, flag.size())));
    if (found != values.end()) {
      line = flag + "=" + found->second;
      values.erase(found);
    }
    text += line + "\n";
  }
  // Options that the version that wrote the run did not have.
  for (const auto& [name, value] : values) {
    text += "--" + name + "=" + value + "\n";
  }
  WriteFileAtomically(to.Options(), [&](std::ostream& out) { out << text; });
}

int RefinedRun::Write(RunFolder* folder,
                      const std::function<void(int, int)>& shown) {
  const RunPaths& to = folder->unfinished();
  CopyFiles(to);
  const std::map<int, Rigid3d> poses = PosesOf(run_);
  const WarpedOutput warped = WarpedOf(root_, marker_);
  Refinement refinement;
  WindowFreezer freezer(freeze_, options_.smoothness, to);
  const auto total = static_cast<int>(run_.surfaces.size());
  for (int done = 0; done < total; ++done) {
    shown(done, total);
    RefineSurface(poses, options_, warped, to, std::move(run_.surfaces[done]),
                  &freezer, &refinement);
  }
  shown(total, total);
  refinement.report.Write(to);
  WriteOptions(to);
  const Json summary =
      SummaryWith(refinement, ReadVersionedOrNull(RunPaths(root_).Summary()));
  WriteHtmlReport(to, summary);
  WriteJson(to.Summary(), Versioned(summary), 2);
  folder->CheckHeld();
  folder->Publish(RunStatus::kComplete);
  return refinement.hidden;
}

}  // namespace splitfusion
