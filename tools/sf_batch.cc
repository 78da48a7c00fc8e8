// Runs sf_run and sf_evaluate over many sequences and option files.

#include <gflags/gflags.h>

#include <filesystem>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "interruption.h"
#include "progress_line.h"
#include "splitfusion/pipelines/batch.h"
#include "tool_main.h"

DEFINE_string(sequences, "",
              "Sequence folders and list files (one folder a line, relative "
              "to the list, # comments), separated by commas.");
DEFINE_string(options, "",
              "Flagfiles of sf_run, separated by commas; every sequence is run "
              "with every file. Empty: once with the defaults.");
DEFINE_string(output, "",
              "Folder of the batch: run directories OUTPUT/SEQUENCE/OPTIONS, "
              "summary.csv, summary.json.");
DEFINE_int32(jobs, 1, "Runs at the same time.");
DEFINE_string(ground_truth, "auto",
              "auto (SEQ/gt or SEQ, where groundtruth.txt is), none, or a "
              "folder with one folder per sequence name.");
DEFINE_bool(overwrite, false,
            "Repeat runs that are finished (have a summary.json).");

namespace splitfusion {
namespace {

/// A program beside this one.
std::string Beside(const std::string& name) {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / name)
      .string();
}

BatchOptions OptionsFromFlags() {
  BatchOptions options;
  options.run_program = Beside("sf_run");
  options.evaluate_program = Beside("sf_evaluate");
  options.sequences = ReadSequences(FLAGS_sequences);
  options.option_files = SplitAtCommas(FLAGS_options);
  options.output = FLAGS_output;
  options.jobs = FLAGS_jobs;
  options.ground_truth = FLAGS_ground_truth;
  options.overwrite = FLAGS_overwrite;
  return options;
}

void PrintProgress(const BatchProgress& progress) {
  const BatchResult& last = progress.last;
  ShowProgress(progress.done, progress.total,
               "runs, " + last.run.sequence + " " + last.run.options +
                   (last.exit_code == 0 ? " done" : " FAILED"),
               progress.seconds_left);
}

Stop WantedStop() {
  if (InterruptedTwice()) return Stop::kAtOnce;
  return Interrupted() ? Stop::kWhenReady : Stop::kNo;
}

int Run() {
  CatchInterruption(SecondSignal::kIsTold);
  const BatchOptions options = OptionsFromFlags();
  const std::size_t planned = PlanBatch(options).size();
  const auto results = RunBatch(options, PrintProgress, WantedStop);
  const int failed = CountFailed(results);
  const std::size_t finished = results.size() - failed;
  if (Interrupted() && finished < planned) EndProgress();
  std::cout << FormatBatchTable(results);
  if (Interrupted() && finished < planned) {
    throw std::runtime_error("interrupted after " + std::to_string(finished) +
                             " of " + std::to_string(planned) +
                             " runs; the same command goes on with the batch");
  }
  if (failed == 0) return kExitDone;
  std::cerr << failed << " of " << results.size() << " runs failed; see "
            << "the *.err.log files in their folders\n";
  return kExitFailedRuns;
}

}  // namespace
}  // namespace splitfusion

int main(int argc, char** argv) {
  return splitfusion::ToolMain(
      argc, argv,
      "Runs sf_run, and sf_evaluate where there is a ground truth, for every\n"
      "sequence with every option file.\n"
      "  sf_batch --sequences=list.txt|DIR,DIR --output=DIR\n"
      "           [--options=a.flags,b.flags] [--jobs=N]\n",
      splitfusion::Run);
}
