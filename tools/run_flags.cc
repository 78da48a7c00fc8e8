#include "run_flags.h"

#include <gflags/gflags.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>
#include <vector>

#include "flag_names.h"
#include "sequence_flags.h"
#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/term_registry.h"
#include "splitfusion/pipelines/presets.h"

DEFINE_string(preset, "splitfusion",
              "splitfusion, kinectfusion, dynamicfusion, cofusion or "
              "background_only.");
DEFINE_string(intrinsics, "",
              "fx,fy,cx,cy,width,height; replaces the calibration file.");
DEFINE_double(depth_scale, 0, "Depth units a metre; 0 = calibration file.");
DEFINE_bool(skip_bad_frames, false,
            "Leave out frames whose images are missing or broken.");
DEFINE_double(min_depth, 0.4, "Metres; nearer depth is dropped.");
DEFINE_double(max_depth, 5.0, "Metres; farther depth is dropped.");
DEFINE_double(min_score, 0.4, "Detections below are ignored.");
DEFINE_string(rigid_objects, "background",
              "Rigid classes: background (until they move) or separate "
              "(surfaces of their own).");
DEFINE_string(merge_touching, "",
              "CLASS+CLASS,...: what touches an instance of an entry's first "
              "class is a part of it, as in person+teddy bear.");
DEFINE_string(terms, splitfusion::PipelineOptions().terms,
              "The energy: NAME(weight=,loss=,scale=) ...");
DEFINE_double(prior_anneal, 8, "First factor on the priors' weights.");
DEFINE_string(solver, "gn_pcg",
              "gn_pcg or gn_cholesky (block Gauss-Newton), or ceres.");
DEFINE_string(linear_solver, "auto",
              "auto, dense_qr, dense_normal_cholesky, sparse_normal_cholesky "
              "or cgnr.");
DEFINE_string(preconditioner, "auto",
              "Of gn_pcg: two_level (auto), jacobi, block_ic0 or identity; of "
              "cgnr: jacobi (auto) or identity.");
DEFINE_string(trust_region, "levenberg_marquardt",
              "levenberg_marquardt or dogleg.");
DEFINE_int32(solver_threads, 1,
             "Threads of Ceres; more change the last digits.");
DEFINE_int32(solver_iterations, 1, "Solver iterations per association.");
DEFINE_int32(linear_iterations, 100,
             "Conjugate gradient iterations of a step at most (gn_pcg, cgnr).");
DEFINE_double(eta, 0.01,
              "Relative accuracy of a step's linear solve (gn_pcg, cgnr).");
DEFINE_double(function_tolerance, 1e-10,
              "Converged when the cost changes by less, relative.");
DEFINE_double(gradient_tolerance, 1e-10,
              "Converged when the gradient's largest entry is below.");
DEFINE_double(parameter_tolerance, 1e-8,
              "Converged when the step is below (radians, metres).");
DEFINE_double(initial_radius, 1e3,
              "First radius of the trust region; 1 / damping.");
DEFINE_bool(full_report, false, "Write Ceres' FullReport() of every solve.");
DEFINE_double(rigid_distance, 0.10, "First rigid gate, metres (ends at half).");
DEFINE_double(rigid_angle, 30, "First rigid gate, degrees (ends at 2/3).");
DEFINE_double(non_rigid_distance, 0.10,
              "First non-rigid gate, metres (ends at half).");
DEFINE_double(non_rigid_angle, 45, "Non-rigid gate, degrees.");
DEFINE_int32(neighbors_per_point, 6, "K, nodes that carry a point (Eq. 3).");
DEFINE_int32(neighbors_per_node, 8, "Edges of a node.");
DEFINE_double(near_spacing, 0.025, "Node spacing up to 0.7 m, metres.");
DEFINE_double(far_spacing, 0.040, "Node spacing from 1.5 m on, metres.");
DEFINE_int32(max_nodes, 2000, "Of a graph; its spacing grows to keep it.");
DEFINE_double(growth_batch, 0.005,
              "New nodes wait until they are so many, as a part of the graph's "
              "(fewer, larger growths are faster).");
DEFINE_double(background_voxel, 0.010, "Voxel size of the background, metres.");
DEFINE_double(object_voxel, 0.005, "Voxel size of other surfaces, metres.");
DEFINE_double(background_truncation, 0.04,
              "Truncation of the background's distances, metres.");
DEFINE_double(object_truncation, 0.03,
              "Truncation of the distances of other surfaces, metres.");
DEFINE_double(max_weight, 64, "Cap of a voxel's weight in the running mean.");
DEFINE_double(object_free_weight, 0.3,
              "Cap of a voxel's weight where an object was found gone.");
DEFINE_double(background_min_piece, 0.01,
              "Smaller pieces of the background's final mesh are left out, "
              "m^2.");
DEFINE_double(object_looks, 2,
              "Frames that must have seen a new part of a deforming object "
              "before it is meshed; more where it was found empty before.");
DEFINE_double(object_min_piece, 0.0025,
              "Smaller pieces of other surfaces' final meshes are left out, "
              "m^2.");
DEFINE_double(min_exposure, 0.25,
              "Surfaces are carried on, not tracked, while less of them is in "
              "view beside others; 0 = never.");
DEFINE_int32(render_stride, 2, "Model maps hold every n-th pixel.");

namespace splitfusion {
namespace {

PinholeCamera ParseIntrinsics(const std::string& text) {
  std::stringstream stream(text);
  PinholeCamera camera;
  char comma[5] = {};
  if (!(stream >> camera.fx >> comma[0] >> camera.fy >> comma[1] >> camera.cx >>
        comma[2] >> camera.cy >> comma[3] >> camera.width >> comma[4] >>
        camera.height) ||
      std::string(comma, 5) != ",,,,," || !(stream >> std::ws).eof()) {
    throw InputError("--intrinsics=" + text +
                     ": expected fx,fy,cx,cy,width,height");
  }
  try {
    camera.Check();
  } catch (const InputError& error) {
    throw InputError("--intrinsics=" + text + ": " + error.what());
  }
  return camera;
}

/// Finer ones would need more memory than there is, and end in OpenVDB.
constexpr double kMinVoxel = 0.001;  // Metres.

void CheckVoxel(const std::string& flag, double value) {
  CheckOption(value >= kMinVoxel && value < 1, flag, value,
              "metres from 0.001 to below 1");
}

/// The energy is text within a text: what is wrong in it names the flag.
void CheckTerms() {
  try {
    ParseEnergy(FLAGS_terms, BuiltinTerms());
  } catch (const OptionError& error) {
    throw InputError(std::string("--terms: ") + error.what());
  }
}

void SetGates(TrackerOptions* tracker) {
  const double radians = M_PI / 180;
  const double shrink[] = {1.0, 0.7, 0.5};
  const double turn[] = {1.0, 5.0 / 6, 2.0 / 3};
  for (std::size_t i = 0; i < tracker->rigid.size(); ++i) {
    AssociationGates& gates = tracker->rigid[i].gates;
    gates.distance = FLAGS_rigid_distance * shrink[i];
    gates.normal_angle = FLAGS_rigid_angle * radians * turn[i];
  }
  for (std::size_t i = 0; i < tracker->non_rigid.size(); ++i) {
    AssociationGates& gates = tracker->non_rigid[i].gates;
    gates.distance = FLAGS_non_rigid_distance * (i == 0 ? 1.0 : 0.5);
    gates.normal_angle = FLAGS_non_rigid_angle * radians;
  }
  tracker->prior_anneal = FLAGS_prior_anneal;
}

void SetSolver(SolverOptions* solver) {
  solver->solver = FLAGS_solver;
  solver->linear_solver = FLAGS_linear_solver;
  solver->preconditioner = FLAGS_preconditioner;
  solver->trust_region = FLAGS_trust_region;
  solver->threads = FLAGS_solver_threads;
  solver->max_iterations = FLAGS_solver_iterations;
  solver->max_linear_solver_iterations = FLAGS_linear_iterations;
  solver->eta = FLAGS_eta;
  solver->function_tolerance = FLAGS_function_tolerance;
  solver->gradient_tolerance = FLAGS_gradient_tolerance;
  solver->parameter_tolerance = FLAGS_parameter_tolerance;
  solver->initial_radius = FLAGS_initial_radius;
  solver->full_report = FLAGS_full_report;
}

void SetModel(PipelineOptions* options) {
  GraphOptions graph;
  graph.neighbors_per_point = FLAGS_neighbors_per_point;
  graph.neighbors_per_node = FLAGS_neighbors_per_node;
  graph.near_spacing = FLAGS_near_spacing;
  graph.far_spacing = FLAGS_far_spacing;
  graph.max_nodes = FLAGS_max_nodes;
  graph.growth_batch = FLAGS_growth_batch;
  options->background.graph = graph;
  options->object.graph = graph;
  options->background.tsdf = {FLAGS_background_voxel,
                              FLAGS_background_truncation, FLAGS_max_weight,
                              FLAGS_max_weight};
  options->background.min_piece_area = FLAGS_background_min_piece;
  options->object.min_piece_area = FLAGS_object_min_piece;
  options->object.looks = FLAGS_object_looks;
  options->object.tsdf = {FLAGS_object_voxel, FLAGS_object_truncation,
                          FLAGS_max_weight, FLAGS_object_free_weight};
}

/// Checks the parts of which several have a field of the same name, or one that
/// is not named as its flag.
void CheckParts(const PipelineOptions& options) {
  CheckTerms();
  CheckVoxel("background_voxel", FLAGS_background_voxel);
  CheckVoxel("object_voxel", FLAGS_object_voxel);
  for (const TrackingStage& stage : options.tracker.rigid) {
    NamingFlags({{"gate distance", "rigid_distance"},
                 {"gate normal_angle", "rigid_angle"}},
                [&] { stage.gates.Check(); });
  }
  for (const TrackingStage& stage : options.tracker.non_rigid) {
    NamingFlags({{"gate distance", "non_rigid_distance"},
                 {"gate normal_angle", "non_rigid_angle"}},
                [&] { stage.gates.Check(); });
  }
  NamingFlags({{"max_iterations", "solver_iterations"},
               {"max_linear_solver_iterations", "linear_iterations"}},
              [&] { options.solver.Check(); });
  NamingFlags({{"truncation", "background_truncation"},
               {"min_piece_area", "background_min_piece"}},
              [&] { options.background.Check(); });
  NamingFlags({{"truncation", "object_truncation"},
               {"max_free_weight", "object_free_weight"},
               {"looks", "object_looks"},
               {"min_piece_area", "object_min_piece"}},
              [&] { options.object.Check(); });
}

}  // namespace

TumReaderOptions ReaderOptionsFromFlags() {
  TumReaderOptions options = FramesFromFlags();
  options.depth_scale = FLAGS_depth_scale;
  options.skip_bad_frames = FLAGS_skip_bad_frames;
  options.depth_filter.min_depth = FLAGS_min_depth;
  options.depth_filter.max_depth = FLAGS_max_depth;
  if (!FLAGS_intrinsics.empty()) {
    options.camera = ParseIntrinsics(FLAGS_intrinsics);
  }
  options.Check();
  return options;
}

PipelineOptions PipelineOptionsFromFlags() {
  PipelineOptions options;
  ApplyPreset(FLAGS_preset, &options);
  options.split.min_score = FLAGS_min_score;
  options.split.rigid_objects = ParseRigidObjects(FLAGS_rigid_objects);
  options.split.merge_touching = ParseMergeGroups(FLAGS_merge_touching);
  options.terms = FLAGS_terms;
  options.render_stride = FLAGS_render_stride;
  options.min_exposure = FLAGS_min_exposure;
  SetGates(&options.tracker);
  SetSolver(&options.solver);
  SetModel(&options);
  CheckParts(options);
  options.Check();
  return options;
}

bool IsRunFlag(const gflags::CommandLineFlagInfo& flag) {
  const std::string file =
      std::filesystem::path(flag.filename).filename().string();
  for (const char* own :
       {"sf_run.cc", "run_flags.cc", "mask_flags.cc", "network_flags.cc",
        "sequence_flags.cc", "identity_flags.cc"}) {
    if (file == own) return true;
  }
  return false;
}

std::string FlagfileText() {
  // Where a run goes and what may be replaced is not a part of what it does:
  // --flagfile=RUN/options.flags --output=NEW repeats it.
  const std::set<std::string> left_out = {
      "output", "overwrite", "keep_same", "resume", "print_identity", "set"};
  std::vector<gflags::CommandLineFlagInfo> flags;
  gflags::GetAllFlags(&flags);
  std::string text;
  for (const gflags::CommandLineFlagInfo& flag : flags) {
    if (!IsRunFlag(flag) || left_out.count(flag.name) > 0) continue;
    text += "--" + flag.name + "=" + flag.current_value + "\n";
  }
  return text;
}

}  // namespace splitfusion
