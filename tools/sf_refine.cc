// Finds the motions of what was hidden in a finished run anew.

#include <gflags/gflags.h>

#include <iostream>
#include <string>
#include <vector>

#include "progress_line.h"
#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/thread_limit.h"
#include "splitfusion/pipelines/refined_run.h"
#include "tool_main.h"

DEFINE_string(output, "", "Run directory to write.");
DEFINE_bool(overwrite, false, "Replace an earlier run in --output.");
DEFINE_double(refine_smoothness, splitfusion::HiddenMotionOptions().smoothness,
              "Weight of smoothness in time of what was hidden, of that of its "
              "shape.");
DEFINE_int32(refine_window, splitfusion::HiddenMotionOptions().window,
             "Frames of which the motions are found together.");
DEFINE_int32(refine_samples, splitfusion::HiddenMotionOptions().samples,
             "Solutions under noise from which deviations of what was hidden "
             "are estimated; 0 = none.");
DEFINE_int32(freeze, 0,
             "Write every N-th window of a surface as a problem for sf_solve; "
             "0 = none.");
DEFINE_int32(threads, 0, "Threads; 0 = all cores. The result is the same.");

namespace splitfusion {
namespace {

constexpr char kUsage[] =
    "Finds the motions of what was hidden, between its last and its next "
    "sight,\nanew in a finished run, and writes that as a run of its own.\n"
    "  sf_refine RUN --output=NEW [--refine_smoothness=N]\n";

int Run(const std::vector<std::string>& arguments) {
  CheckOption(arguments.size() == 1, "RUN", arguments.size(),
              "one run directory");
  CheckOption(!FLAGS_output.empty(), "output", "''", "a folder to write");
  CheckIsOutside("RUN", arguments.front(), FLAGS_output, "--output");
  CheckIsOutside("output", FLAGS_output, arguments.front(), "RUN");
  HiddenMotionOptions options;
  options.smoothness = FLAGS_refine_smoothness;
  options.window = FLAGS_refine_window;
  options.samples = FLAGS_refine_samples;
  CheckOption(FLAGS_freeze >= 0, "freeze", FLAGS_freeze, ">= 0");
  RefinedRun refined(arguments.front(), options, FLAGS_freeze);
  const ThreadLimit threads(FLAGS_threads);
  RunFolderOptions folder_options;
  folder_options.overwrite = FLAGS_overwrite;
  folder_options.resume = false;
  RunFolder folder(FLAGS_output, refined.Identity(), folder_options);
  if (folder.start() == RunStart::kFinished) {
    std::cout << FLAGS_output << ": holds the finished run of these options; "
              << "nothing to do\n";
    return kExitDone;
  }
  ProgressLine progress;
  const int hidden = refined.Write(&folder, [&](int done, int total) {
    progress.Show(done, total, "surfaces", 0);
  });
  progress.End();
  std::cout << FLAGS_output << ": " << hidden
            << " motions of hidden nodes were found anew\n";
  return kExitDone;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  std::vector<std::string> arguments;
  return splitfusion::ToolMain(
      argc, argv, splitfusion::kUsage,
      [&] { return splitfusion::Run(arguments); }, "", &arguments);
}
