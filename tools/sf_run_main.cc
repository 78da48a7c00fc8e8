#include "sf_run_main.h"

#include <gflags/gflags.h>
#include <glog/logging.h>

#include <cstdint>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "identity_flags.h"
#include "interruption.h"
#include "mask_flags.h"
#include "method_flags.h"
#include "progress_line.h"
#include "run_flags.h"
#include "sequence_flags.h"
#include "splitfusion/lib/base/content_hash.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/thread_limit.h"
#include "splitfusion/lib/energy/terms_library.h"
#include "splitfusion/lib/report/disk_space.h"
#include "splitfusion/lib/report/library_versions.h"
#include "splitfusion/lib/report/run_folder.h"
#include "splitfusion/lib/report/run_marker.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "splitfusion/pipelines/sequence_run.h"
#include "tool_main.h"

DEFINE_string(output, "", "Run directory to write.");
DEFINE_bool(overwrite, false, "Replace an earlier run in --output.");
DEFINE_bool(keep_same, false,
            "With --overwrite: keep a run with the same result.");
DEFINE_bool(resume, true, "Go on with an unfinished run of the same options.");
DEFINE_int32(checkpoint_every, 0,
             "Frames between checkpoints; 0 = by time, -1 = never.");
DEFINE_bool(keep_checkpoints, false, "Keep all checkpoints, for --from.");
DEFINE_string(from, "", "Run with --keep_checkpoints to start from.");
DEFINE_int32(at, 0, "First frame to compute after --from.");
DEFINE_bool(help_terms, false, "Print all terms with their keys, and end.");
DEFINE_string(terms_library, "", "Libraries with terms of your own: FILE,...");
DEFINE_bool(print_options, false, "Print all options of the method, and end.");
DEFINE_bool(print_identity, false, "Print what decides the result, and end.");
DEFINE_int32(warped_every, 10, "Warped meshes of every n-th frame; 0 = none.");
DEFINE_int32(pictures_every, 10, "Pictures of every n-th frame; 0 = none.");
DEFINE_bool(warped_whole, false,
            "Warped meshes show also what was seen only later.");
DEFINE_bool(write_masks, true, "Write refined masks of every frame.");
DEFINE_int32(covariance, 0, "Uncertainty of surfaces, every n-th frame.");
DEFINE_int32(freeze, 0, "Problems of every n-th frame, for sf_solve.");
DECLARE_string(format);
DECLARE_string(masks);
DECLARE_string(preset);
DECLARE_string(sequence);
DECLARE_string(trajectory);
DECLARE_int32(threads);

namespace splitfusion {
namespace {

/// The run directory as the flags ask for it.
RunFolder OpenRunFolder(const RunIdentity& identity) {
  RunFolderOptions options;
  options.overwrite = FLAGS_overwrite;
  options.keep_same = FLAGS_keep_same;
  options.resume = FLAGS_resume;
  return RunFolder(FLAGS_output, identity, options);
}

std::unique_ptr<Reconstruction> MakeReconstruction(
    const ReaderOptions& reading, const PipelineOptions& options,
    const Registries& registries) {
  return std::make_unique<Reconstruction>(
      FLAGS_sequence, reading, options, LabelsFromFlags(),
      [&](const ImageFolderReader& reader) {
        return SegmenterFromFlags(reader, options,
                                  RunPaths(FLAGS_output).Unfinished());
      },
      registries);
}

SequenceRunOptions RunOptionsFromFlags() {
  SequenceRunOptions options;
  options.warped = {FLAGS_warped_every, FLAGS_warped_whole};
  options.pictures_every = FLAGS_pictures_every;
  options.write_masks = FLAGS_write_masks;
  options.checkpoint_every = FLAGS_checkpoint_every;
  options.keep_checkpoints = FLAGS_keep_checkpoints;
  options.reads_ahead = ResolveThreads(FLAGS_threads) > 1;
  options.from = {FLAGS_from, FLAGS_at};
  if (FLAGS_freeze > 0) {
    options.recorder = std::make_shared<ProblemRecorder>(FLAGS_freeze);
  }
  if (FLAGS_covariance > 0) {
    options.solutions = std::make_shared<SolutionRecorder>(FLAGS_covariance);
  }
  options.facts = {FLAGS_preset, FlagfileText(), LibraryVersions()};
  return options;
}

SequenceRunHooks Hooks(ProgressLine* progress) {
  SequenceRunHooks hooks;
  hooks.interrupted = Interrupted;
  hooks.warn = [progress](const std::string& line) {
    progress->End();
    LOG(WARNING) << line;
  };
  hooks.tell = [](const std::string& line) { LOG(INFO) << line; };
  hooks.shown = [progress](const RunProgress& run) {
    static const std::map<RunPass, std::string> kDone = {
        {RunPass::kTracking, "frames, "},
        {RunPass::kRefining, "refined, "},
        {RunPass::kColoring, "frames seen for colours, "}};
    progress->Show(
        run.done, run.total,
        kDone.at(run.pass) + std::to_string(run.surfaces) + " surfaces",
        run.seconds_left);
  };
  return hooks;
}

/// A full disk is better found before the first frame than after the last.
void CheckDisk(const ImageFolderReader& reader, RunFolder* folder) {
  if (folder->start() != RunStart::kFresh) return;
  const PinholeCamera& camera = reader.camera();
  try {
    CheckDiskSpace(folder->unfinished().root(),
                   EstimatedBytes({std::int64_t{camera.width} * camera.height,
                                   reader.size(), FLAGS_pictures_every,
                                   FLAGS_checkpoint_every >= 0}));
  } catch (const InputError& error) {
    folder->RecordFailure(error.what());
    throw;
  }
}

/// A state of other images or of another camera is of no use.
void CheckFrom(ReaderOptions reading, const FormatRegistry& formats) {
  if (FLAGS_from.empty()) return;
  const std::optional<RunMarker> marker = ReadRunMarker(FLAGS_from);
  CheckOption(marker.has_value(), "from", FLAGS_from,
              "a run with a run.json and --keep_checkpoints");
  const NamedValues& parts = marker->identity.parts;
  const auto count = parts.find("input.frame_count");
  if (count != parts.end()) reading.max_frames = std::stoi(count->second);
  for (const auto& [name, here] :
       InputParts(ImageFolderReader(FLAGS_sequence, reading, formats))) {
    const auto there = parts.find(name);
    CheckOption(there != parts.end() && there->second == here, "from",
                FLAGS_from, "a run of this sequence, but " + name + " differs");
  }
}

/// What needs no file to be looked at.
void CheckValues() {
  ResolveThreads(FLAGS_threads);
  CheckOption(FLAGS_warped_every >= 0, "warped_every", FLAGS_warped_every,
              "a number of frames, or 0");
  CheckOption(FLAGS_pictures_every >= 0, "pictures_every", FLAGS_pictures_every,
              "a number of frames, or 0");
  CheckOption(FLAGS_freeze >= 0, "freeze", FLAGS_freeze,
              "a number of frames, or 0");
  CheckOption(FLAGS_covariance >= 0, "covariance", FLAGS_covariance,
              "a number of frames, or 0");
  CheckOption(FLAGS_checkpoint_every >= -1, "checkpoint_every",
              FLAGS_checkpoint_every, "a number of frames, 0 or -1");
  CheckOption(!FLAGS_keep_checkpoints || FLAGS_checkpoint_every > 0,
              "keep_checkpoints", "true", "--checkpoint_every above 0");
  CheckOption(FLAGS_at >= 0, "at", FLAGS_at, "a number of frames");
  CheckOption(FLAGS_at == 0 || !FLAGS_from.empty(), "at", FLAGS_at,
              "--from beside it");
  CheckOption(!FLAGS_keep_same || FLAGS_overwrite, "keep_same", "true",
              "--overwrite beside it");
}

void CheckOutput() {
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  if (!FLAGS_overwrite) return;
  for (const auto& [flag, path] :
       {std::pair("sequence", FLAGS_sequence), std::pair("masks", FLAGS_masks),
        std::pair("from", FLAGS_from),
        std::pair("trajectory", FLAGS_trajectory)}) {
    CheckIsOutside(flag, path, FLAGS_output, "--output, which is overwritten");
  }
}

/// @throw OptionError on what cannot be had together.
void CheckTogether(const ReaderOptions& reading,
                   const PipelineOptions& options) {
  CheckOption(reading.trajectory.empty() || !options.deform_background,
              "trajectory", reading.trajectory,
              "a background that does not deform");
}

/// The run itself, unless --output holds it.
int Reconstruct(
    const ReaderOptions& reading, const PipelineOptions& options,
    Registries registries,
    const std::function<RunIdentity(const ImageFolderReader&)>& identify) {
  CheckFrom(reading, registries.formats);
  const ThreadLimit threads(FLAGS_threads);
  const SequenceRunOptions run_options = RunOptionsFromFlags();
  if (run_options.recorder) {
    registries.solvers = run_options.recorder->Watch(registries.solvers);
  }
  if (run_options.solutions) {
    registries.solvers = run_options.solutions->Watch(registries.solvers);
  }
  const auto make = [&] {
    return MakeReconstruction(reading, options, registries);
  };
  std::unique_ptr<Reconstruction> work = make();
  RunFolder folder = OpenRunFolder(identify(work->reader));
  if (folder.start() == RunStart::kFinished) {
    std::cout << FLAGS_output << ": holds the finished run of these options "
              << "and this input; nothing to do\n";
    return kExitDone;
  }
  CheckDisk(work->reader, &folder);
  CatchInterruption();
  ProgressLine progress;
  SequenceRun run(std::move(work), make, &folder, run_options,
                  Hooks(&progress));
  run.Execute();
  const RunSummary summary = run.Summary();
  std::cout << VerdictLine(summary) << std::endl;
  for (const std::string& line : HoldLines(summary)) {
    std::cout << line << std::endl;
  }
  return kExitDone;
}

/// Whether a program has added to what comes with the toolkit.
bool HasOwnCode(const Registries& registries) {
  const Registries builtin;
  return registries.terms.names() != builtin.terms.names() ||
         registries.associations.names() != builtin.associations.names() ||
         registries.solvers.names() != builtin.solvers.names() ||
         registries.formats.names() != builtin.formats.names();
}

/// The hash of the contents of files, whatever their order; "none" without any.
std::string HashOfFiles(const std::vector<std::string>& paths) {
  std::set<std::string> hashes;
  for (const std::string& path : paths) hashes.insert(HashOfFile(path));
  ContentHash all;
  for (const std::string& hash : hashes) all.Add(hash);
  return hashes.empty() ? "none" : all.Hex();
}

int RunSequence(Registries registries) {
  // Code that is not the toolkit's may change the result.
  const std::string program =
      HasOwnCode(registries) ? HashOfFile("/proc/self/exe") : "sf_run";
  const std::string libraries =
      HashOfFiles(LoadTermsLibraries(FLAGS_terms_library, &registries.terms));
  if (FLAGS_help_terms) {
    std::cout << TermsHelp(registries.terms);
    return kExitDone;
  }
  if (FLAGS_print_options) {
    std::cout << MethodOptionsMarkdown(registries);
    return kExitDone;
  }
  ApplySetFlag(registries.terms);
  ReaderOptions reading = ReaderOptionsFromFlags();
  const PipelineOptions options = PipelineOptionsFromFlags(registries);
  CheckValues();
  CheckTogether(reading, options);
  if (!FLAGS_print_identity) CheckOutput();
  // By its name, so that the options repeat the run and tell how to read again.
  FLAGS_format = reading.format =
      ResolveFormat(reading.format, FLAGS_sequence, registries.formats);
  const auto identify = [&](const ImageFolderReader& reader) {
    RunIdentity identity = IdentityFromFlags(reader, registries.terms);
    identity.parts["program"] = program;
    identity.parts["terms_libraries"] = libraries;
    return identity;
  };
  if (FLAGS_print_identity) {
    std::cout << IdentityText(identify(
        ImageFolderReader(FLAGS_sequence, reading, registries.formats)));
    return kExitDone;
  }
  return Reconstruct(reading, options, registries, identify);
}

}  // namespace

int SfRunMain(int argc, char** argv, Registries registries) {
  RegisterMethodFlags();
  return ToolMain(
      argc, argv,
      "Tracks and maps the rigid and non-rigid objects of an RGB-D sequence.\n"
      "sf_run --sequence=DIR --output=RUN [--masks=DIR|none | "
      "--model=FILE.onnx]\n",
      [&] { return RunSequence(std::move(registries)); }, "sf_run_main");
}

}  // namespace splitfusion
