// Compares a run with its live depth, a run, a trajectory or a mesh with ground
// truth, and says where a run carries surface points.

#include <gflags/gflags.h>

#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "splitfusion/lib/base/atomic_file.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/json_file.h"
#include "splitfusion/lib/evaluation/evaluation_json.h"
#include "splitfusion/lib/evaluation/evaluation_table.h"
#include "splitfusion/lib/evaluation/motion_calibration.h"
#include "splitfusion/lib/evaluation/point_follower.h"
#include "splitfusion/lib/evaluation/run_evaluation.h"
#include "splitfusion/lib/evaluation/track_point.h"
#include "splitfusion/lib/page/curve_chart.h"
#include "splitfusion/lib/page/html_report.h"
#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/report/run_paths.h"
#include "tool_main.h"

DEFINE_string(run, "", "Directory of a run of sf_run.");
DEFINE_string(ground_truth, "",
              "With --run: folder with gt/groundtruth.txt or groundtruth.txt; "
              "with --trajectory: a TUM file.");
DEFINE_string(trajectory, "", "TUM file to compare with --ground_truth.");
DEFINE_string(mesh, "", "PLY to compare with --ground_truth_mesh.");
DEFINE_string(ground_truth_mesh, "", "PLY of the truth, in the same frame.");
DEFINE_string(output, "",
              "JSON file of the result; default RUN/evaluation.json.");
DEFINE_bool(check_only, false, "Check the flags and end.");
DEFINE_double(max_time_difference, 0.02, "Between matching poses; seconds.");
DEFINE_int32(samples, 100000, "Random points on each of two surfaces.");
DEFINE_double(max_distance, 0.3,
              "Larger surface distances count as this; metres.");
DEFINE_double(min_seen, 3,
              "Completeness counts true triangles whose property seen is not "
              "less.");
DEFINE_int32(label, -1,
             "Only triangles of the static truth with this vertex property "
             "label (0 = room without furniture); -1 = all.");
DEFINE_int32(depth_every, 10,
             "Compare with live depth in every n-th frame; 0 = never.");
DEFINE_bool(whole_model, false,
            "Judge all of the final model that is in use in a frame, also what "
            "was seen only later.");
DEFINE_bool(with_unknown, true,
            "Judge all that had been seen by each frame; there is no other "
            "measure any more.");
DEFINE_string(track_query, "",
              "CSV id,frame,x,y,z (camera frame, metres): points of one frame "
              "to follow through --run.");
DEFINE_string(track_output, "", "CSV to write the followed points to.");
DEFINE_int32(track_frames, 30,
             "Number of frames through which they are followed.");
DEFINE_string(track_frame, "-1",
              "Frames in which true points are taken, as 30,46,60; -1 = the "
              "one in which most are visible.");
DEFINE_string(calibration, "",
              "Name of a .json and an .svg to write: deviations of a run with "
              "--covariance=1 against the true errors.");
DEFINE_double(uncertainty_scale, 1, "What they are multiplied by.");
DEFINE_int32(uncertainty_every, 1, "Of its frames, every n-th.");
DEFINE_int32(presence_every, 1,
             "Presence and shape in every n-th frame; 0 = never.");
DEFINE_int32(plain_view_pixels, 8000,
             "An instance with more pixels is in plain view.");

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Compares results with live depth and ground truth; one of\n"
    "  sf_evaluate --run=RUN [--ground_truth=DIR]\n"
    "  sf_evaluate --run=RUN --track_query=CSV --track_output=CSV\n"
    "  sf_evaluate --run=RUN --ground_truth=DIR --calibration=NAME\n"
    "  sf_evaluate --trajectory=FILE --ground_truth=FILE\n"
    "  sf_evaluate --mesh=PLY --ground_truth_mesh=PLY\n";

/// The frames of --track_frame; none for -1.
std::vector<int> TrackFrames() {
  std::vector<int> frames;
  if (FLAGS_track_frame == "-1") return frames;
  std::istringstream words(FLAGS_track_frame + ",");
  for (std::string word; std::getline(words, word, ',');) {
    const bool digits =
        !word.empty() && word.size() < 9 &&
        word.find_first_not_of("0123456789") == std::string::npos;
    CheckOption(digits, "track_frame", FLAGS_track_frame,
                "frame indices with commas between them, or -1");
    frames.push_back(std::stoi(word));
  }
  return frames;
}

EvaluationOptions OptionsFromFlags() {
  EvaluationOptions options;
  options.trajectory.max_time_difference = FLAGS_max_time_difference;
  options.surface.samples = FLAGS_samples;
  options.surface.max_distance = FLAGS_max_distance;
  options.surface.min_seen = FLAGS_min_seen;
  if (FLAGS_label >= 0) options.surface.label = FLAGS_label;
  options.tracks.references = TrackFrames();
  options.tracks.frames = FLAGS_track_frames;
  options.presence_every = FLAGS_presence_every;
  options.presence.plain_view_pixels = FLAGS_plain_view_pixels;
  options.depth_every = FLAGS_depth_every;
  options.Check();
  return options;
}

/// Prints the table and writes the JSON to --output, or else to
/// `default_path` if that is not empty.
void Publish(const std::string& table, const nlohmann::ordered_json& json,
             const std::string& default_path) {
  std::cout << table;
  const std::string& path = FLAGS_output.empty() ? default_path : FLAGS_output;
  if (!path.empty()) WriteJson(path, Versioned(json), 2);
}

void EvaluateTrajectory(const EvaluationOptions& options) {
  Trajectory estimate = ReadTumTrajectory(FLAGS_trajectory);
  if (estimate.empty()) throw InputError(FLAGS_trajectory + ": no pose");
  Trajectory truth = ReadTumTrajectory(FLAGS_ground_truth);
  if (truth.empty()) throw InputError(FLAGS_ground_truth + ": no pose");
  const TrajectoryError error = CompareTrajectories(
      std::move(estimate), std::move(truth), options.trajectory);
  Publish(FormatTable(error), ToJson(error), "");
}

void EvaluateMesh(const EvaluationOptions& options) {
  const TriangleMesh mesh = ReadPly(FLAGS_mesh);
  if (mesh.empty()) throw InputError(FLAGS_mesh + ": no vertex");
  const SurfaceError error = CompareSurfaces(
      mesh, ReadTrueSurface(FLAGS_ground_truth_mesh), options.surface);
  Publish(FormatTable("mesh", error), ToJson(error), "");
}

void FollowQueries(const RecordedRun& run,
                   const std::vector<AnimatedSurface>& surfaces,
                   const EvaluationOptions& options) {
  const FollowedPoints followed = FollowPoints(
      run, surfaces, ReadTrackPoints(FLAGS_track_query), options.tracks.frames);
  WriteTrackPoints(FLAGS_track_output, followed.points);
  std::cout << FLAGS_track_output << ": " << followed.attached << " points, "
            << followed.unattached << " that no surface is near to"
            << (followed.by_mask ? "; surfaces by mask" : "") << '\n';
}

CurveChart CalibrationChart(const MotionCalibration& calibration) {
  CurveChart chart;
  chart.title = "Motions of points from frame to frame, " +
                std::to_string(calibration.points) + " points";
  chart.x.label = "share within a multiple of sigma, expected";
  chart.y.label = "share observed";
  for (int axis = 0; axis < 3; ++axis) {
    chart.curves.push_back(
        {std::string(1, "xyz"[axis]), calibration.curves[axis]});
  }
  chart.curves.push_back({"as expected", {{0, 0}, {1, 1}}});
  return chart;
}

void CalibrateUncertainty(const RecordedRun& run,
                          const std::vector<AnimatedSurface>& surfaces,
                          const GroundTruth& truth) {
  const MotionCalibration calibration =
      Calibrate(MotionErrors(run, surfaces, truth, FLAGS_uncertainty_every),
                FLAGS_uncertainty_scale);
  WriteJson(FLAGS_calibration + ".json", Versioned(ToJson(calibration)), 2);
  WriteFileAtomically(FLAGS_calibration + ".svg", [&](std::ostream& out) {
    out << CurveChartSvg(CalibrationChart(calibration));
  });
  std::cout << calibration.points << " points; within two deviations along x, "
            << "y, z: " << calibration.within_two[0] << ' '
            << calibration.within_two[1] << ' ' << calibration.within_two[2]
            << " with scale " << calibration.scale
            << "; fitted scale: " << calibration.fitted_scale << '\n';
}

/// What is read of a run must be as the run wrote it.
void CheckRunFiles() {
  const std::optional<RunMarker> marker = ReadRunMarker(FLAGS_run);
  if (!marker) return;  // Of an older version, or made by hand.
  for (const auto& [path, file] : marker->files) {
    const std::string first = std::filesystem::path(path).begin()->string();
    const bool is_read = first == "surfaces" || path == "trajectory.txt" ||
                         path == "frames.jsonl" || path == "options.flags" ||
                         path == "calibration.txt";
    if (is_read) CheckRunFile(*marker, FLAGS_run, path);
  }
}

/// What is in RUN/unfinished alone cannot be judged yet.
void CheckIsThere() {
  namespace fs = std::filesystem;
  const RunPaths paths(FLAGS_run);
  const bool only_begun =
      !fs::exists(paths.Trajectory()) && fs::exists(paths.Unfinished());
  if (!only_begun) return;
  throw InputError(FLAGS_run +
                   ": holds an unfinished run alone (in unfinished): expected "
                   "one that has ended; the same command goes on with "
                   "it");
}

/// The page of the run, if it has one, with its evaluation, which does not
/// depend on it.
void RenewPage() try {
  const RunPaths paths(FLAGS_run);
  if (!std::filesystem::exists(paths.HtmlReport())) return;
  const std::string page = HtmlReport({ReadReportedRun(paths)});
  WriteFileAtomically(paths.HtmlReport(),
                      [&](std::ostream& out) { out << page; });
  AddRunFile(FLAGS_run, "report.html");
} catch (const InputError& error) {
  std::cerr << "sf_evaluate: warning: report.html stays as it was: "
            << error.what() << '\n';
}

void EvaluateRunDirectory(const EvaluationOptions& options,
                          const FormatRegistry& formats) {
  CheckIsThere();
  CheckRunFiles();
  RecordedRun run = ReadRun(FLAGS_run);
  run.formats = formats;
  if (!IsComplete(RunPaths(FLAGS_run))) {
    std::cout << FLAGS_run << ": unfinished run (summary.json is missing or "
              << "says so); judged by the frames that it has\n";
  }
  for (RecordedSurface& surface : run.surfaces) {
    if (FLAGS_whole_model) surface.graph.first_seen.clear();
  }
  const auto surfaces = AnimateSurfaces(std::move(run.surfaces));
  std::optional<GroundTruth> truth;
  if (!FLAGS_ground_truth.empty()) truth = ReadGroundTruth(FLAGS_ground_truth);
  if (!FLAGS_track_query.empty()) {
    FollowQueries(run, surfaces, options);
    if (!truth) return;
  }
  if (!FLAGS_calibration.empty()) {
    CalibrateUncertainty(run, surfaces, *truth);
    return;
  }
  RunEvaluation evaluation = EvaluateRun(run, surfaces, truth, options);
  evaluation.whole_model = FLAGS_whole_model;
  Publish(FormatTable(evaluation), ToJson(evaluation),
          RunPaths(FLAGS_run).Evaluation());
  if (!FLAGS_output.empty()) return;
  AddRunFile(FLAGS_run, "evaluation.json");
  RenewPage();
}

/// @throw InputError unless the flags are those of one of the uses.
void CheckUsage() {
  const auto given = [](const std::string& flag) { return !flag.empty(); };
  const int uses = int{given(FLAGS_run)} + int{given(FLAGS_trajectory)} +
                   int{given(FLAGS_mesh)};
  const auto require = [](bool ok, const char* message) {
    if (!ok) throw InputError(message);
  };
  require(uses == 1, "expected one of --run, --trajectory, --mesh; see --help");
  require(given(FLAGS_track_query) == given(FLAGS_track_output),
          "--track_query and --track_output go together");
  require(!FLAGS_whole_model || given(FLAGS_run), "--whole_model needs --run");
  require(FLAGS_with_unknown, "--with_unknown cannot be switched off");
  require(!given(FLAGS_track_query) || given(FLAGS_run),
          "--track_query needs --run");
  require(!given(FLAGS_calibration) ||
              (given(FLAGS_run) && given(FLAGS_ground_truth)),
          "--calibration needs --run and --ground_truth");
  require(!given(FLAGS_trajectory) || given(FLAGS_ground_truth),
          "--trajectory needs --ground_truth");
  require(given(FLAGS_mesh) == given(FLAGS_ground_truth_mesh),
          "--mesh and --ground_truth_mesh go together");
}

int Run(const FormatRegistry& formats) {
  CheckUsage();
  if (!FLAGS_output.empty()) CheckIsNoFileOfARun(FLAGS_output);
  const EvaluationOptions options = OptionsFromFlags();
  if (FLAGS_check_only) return kExitDone;
  if (!FLAGS_trajectory.empty()) {
    EvaluateTrajectory(options);
  } else if (!FLAGS_mesh.empty()) {
    EvaluateMesh(options);
  } else {
    EvaluateRunDirectory(options, formats);
  }
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(argc, argv, splitfusion::kUsage, [] {
    return splitfusion::Run(splitfusion::BuiltinFormats());
  });
}
