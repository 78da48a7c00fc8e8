// Writes a synthetic RGB-D sequence with exact ground truth.

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <string>
#include <vector>

#include "progress_line.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/synthetic/synthetic_writer.h"
#include "tool_main.h"

DEFINE_string(output, "", "Folder to write; it must be new or empty.");
DEFINE_bool(overwrite, false, "Replace an earlier sequence of sf_synth.");
DEFINE_string(scene, "room_person",
              "room_person (room, walking person, soft toy), room, person, "
              "soft_object (alone, nothing around).");
DEFINE_int32(frames, 90, "Number of frames, at 30 Hz.");
DEFINE_int32(width, 640, "Image width in pixels.");
DEFINE_int32(height, 480, "Image height in pixels.");
DEFINE_uint32(seed, 1, "Seed of textures, camera shake, noise and masks.");
DEFINE_string(noise, "on", "Kinect-like depth and colour noise: on or off.");
DEFINE_string(masks, "noisy",
              "Instance masks: noisy (as a detector's) or exact.");
DEFINE_double(camera_motion, 1, "Scale of the camera's path; 0 = fixed.");
DEFINE_double(subject_speed, 1, "Speed of person and toy; 0 = still.");
DEFINE_int32(track_points, 500, "Tracked points per non-rigid instance.");
DEFINE_int32(mesh_every, 25, "Frames between posed ground-truth meshes.");

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Writes a synthetic RGB-D sequence in the TUM layout, with instance masks\n"
    "and exact ground truth (poses, labels, meshes, surface tracks). The same\n"
    "flags give the same bytes.\n"
    "  sf_synth --output=DIR [--scene=room_person] [--frames=90] [--seed=1]\n";

/// True for `yes`, false for `no`.
///
/// @throw InputError on any other word.
bool ParseChoice(const std::string& flag, const std::string& value,
                 const std::string& yes, const std::string& no) {
  CheckOption(value == yes || value == no, flag, value, yes + " or " + no);
  return value == yes;
}

SyntheticOptions OptionsFromFlags() {
  SyntheticOptions options;
  options.scene = ParseSyntheticSceneKind(FLAGS_scene);
  options.frames = FLAGS_frames;
  options.width = FLAGS_width;
  options.height = FLAGS_height;
  options.seed = FLAGS_seed;
  options.noise = ParseChoice("noise", FLAGS_noise, "on", "off");
  options.exact_masks = ParseChoice("masks", FLAGS_masks, "exact", "noisy");
  options.camera_motion = FLAGS_camera_motion;
  options.subject_speed = FLAGS_subject_speed;
  options.track_points = FLAGS_track_points;
  return options;
}

int Run() {
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  SyntheticWriterOptions writer_options;
  writer_options.mesh_every = FLAGS_mesh_every;
  writer_options.overwrite = FLAGS_overwrite;
  const Stopwatch stopwatch;
  ProgressLine progress;
  const std::vector<std::string> kept = WriteSyntheticSequence(
      OptionsFromFlags(), writer_options, FLAGS_output, [&](int done) {
        progress.Show(done, FLAGS_frames, "frames",
                      stopwatch.Seconds() / done * (FLAGS_frames - done));
      });
  progress.End();
  if (!kept.empty()) {
    LOG(WARNING) << FLAGS_output << ": " << kept.size()
                 << " files that sf_synth did not write stay there, such as "
                 << kept.front();
  }
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(argc, argv, splitfusion::kUsage,
                               splitfusion::Run);
}
