#include "run_flags.h"

#include <gflags/gflags.h>

#include <filesystem>
#include <set>
#include <sstream>
#include <vector>

#include "camera_flags.h"
#include "method_flags.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/sequence/sensors.h"
#include "splitfusion/pipelines/presets.h"

DEFINE_string(sensor, "kinect_v1",
              "kinect_v1, kinect_azure, realsense or ideal.");
DEFINE_string(preset, "splitfusion", "Method, by name; see docs/presets.md.");
DEFINE_string(trajectory, "", "TUM text of known camera poses.");

namespace splitfusion {

ReaderOptions ReaderOptionsFromFlags() {
  ReaderOptions options = ImagesFromFlags();
  options.trajectory = FLAGS_trajectory;
  options.depth = SensorOptions(FLAGS_sensor);
  TakeDepthFlags(&options.depth);
  options.Check();
  return options;
}

PipelineOptions PipelineOptionsFromFlags(const Registries& registries) {
  PipelineOptions options;
  ApplyPreset(FLAGS_preset, &options);
  TakeMethodFlags(&options);
  try {
    SurfaceEnergies::Parse(options.terms, registries.terms).Check();
  } catch (const OptionError& error) {
    // A text within a text: what is wrong in it names the flag.
    throw InputError(std::string("--terms: ") + error.what());
  }
  options.Check();
  registries.associations.Check(options.tracker.association);
  registries.solvers.Make(options.solver.solver, options.solver);
  return options;
}

bool IsRunFlag(const gflags::CommandLineFlagInfo& flag) {
  const std::string file =
      std::filesystem::path(flag.filename).filename().string();
  for (const char* own :
       {"sf_run_main.cc", "run_flags.cc", "camera_flags.cc", "mask_flags.cc",
        "network_flags.cc", "sequence_flags.cc", "identity_flags.cc",
        "method_flags.cc", "method_details.cc"}) {
    if (file == own) return true;
  }
  return false;
}

namespace {

/// A path that a flag names, so that it holds in every folder; what is none, as
/// `auto`, as it is.
std::string AbsolutePath(const std::string& value) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool word = value.empty() || value == "auto" || value == "none";
  if (word || !fs::exists(value, error)) return value;
  return fs::absolute(value).lexically_normal().string();
}

/// The value of a flag that names paths, such ones in all folders.
std::string WithAbsolutePaths(const gflags::CommandLineFlagInfo& flag) {
  static const std::set<std::string> paths = {
      "class_names", "color_camera", "feature_model", "from",      "labels",
      "masks",       "model",        "sequence",      "trajectory"};
  if (paths.count(flag.name) > 0) return AbsolutePath(flag.current_value);
  if (flag.name != "terms_library") return flag.current_value;
  std::stringstream libraries(flag.current_value);
  std::string text;
  for (std::string path; std::getline(libraries, path, ',');) {
    text += (text.empty() ? "" : ",") + AbsolutePath(path);
  }
  return text;
}

}  // namespace

std::string FlagfileText() {
  // Where a run goes and what may be replaced is not a part of what it does:
  // --flagfile=RUN/options.flags --output=NEW repeats it.
  const std::set<std::string> left_out = {
      "output", "overwrite",     "keep_same",      "resume",
      "set",    "print_options", "print_identity", "help_terms"};
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  std::string text;
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (!IsRunFlag(flag) || left_out.count(flag.name) > 0) continue;
    text += "--" + flag.name + "=" + WithAbsolutePaths(flag) + "\n";
  }
  return text;
}

}  // namespace splitfusion
