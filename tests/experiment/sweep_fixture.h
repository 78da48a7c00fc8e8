#ifndef SPLITFUSION_TESTS_EXPERIMENT_SWEEP_FIXTURE_H_
#define SPLITFUSION_TESTS_EXPERIMENT_SWEEP_FIXTURE_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/result_table.h"
#include "splitfusion/lib/experiment/sequence_list.h"
#include "splitfusion/lib/experiment/sweep.h"
#include "splitfusion/lib/report/run_marker.h"
#include "support/stub_programs.h"
#include "support/temporary_folder.h"

namespace splitfusion {

/// Sweeps over stub programs.
class SweepTest : public testing::Test {
 protected:
  SweepTest() {
    options_.run_program = WriteScript(folder_, "bin/sf_run", kStubRun);
    options_.runner.evaluate_program =
        WriteScript(folder_, "bin/sf_evaluate", kStubEvaluate);
    options_.output = folder_ / "out";
  }

  /// Adds a sequence with this text as its ground truth; none if it is empty.
  void AddSequence(const std::string& name, const std::string& truth = "") {
    folder_.Write("data/" + name + "/rgb.txt", "");
    if (!truth.empty()) {
      folder_.Write("data/" + name + "/groundtruth.txt", truth);
    }
    experiment_.sequences.push_back(
        ReadSequences(folder_ / ("data/" + name), "auto")[0]);
  }

  SweepOutcome Sweep() { return RunSweep(experiment_, options_); }
  ResultTable Table() const {
    return CollectResults(ExperimentFolder(options_.output));
  }

  /// Path of a file of the n-th row's run.
  std::string InRun(std::size_t row, const std::string& name) const {
    return "out/tasks/" + Table().rows[row].task.name + "/run/" + name;
  }

  /// Lists the files of the n-th row's run in its marker, as sf_run does.
  void ListFiles(std::size_t row) const {
    std::string list;
    for (const auto& [path, file] :
         ListRunFiles(folder_ / InRun(row, ""), {})) {
      list += (list.empty() ? "" : ", ") + ("{\"path\": \"" + path) +
              "\", \"bytes\": " + std::to_string(file.bytes) +
              ", \"xxh3\": \"" + file.xxh3 + "\"}";
    }
    const std::string marker = InRun(row, "run.json");
    std::string text = folder_.Read(marker);
    // The stub knows its marker by the text of the rest.
    text.insert(text.find("\"files\": [") + 10, list);
    folder_.Write(marker, text);
  }

  /// How often sf_run computed something of a sequence.
  long Starts(const std::string& name) const {
    return Lines("data/" + name + "/starts.txt");
  }
  long Lines(const std::string& path) const {
    const std::string text = folder_.Read(path);
    return std::count(text.begin(), text.end(), '\n');
  }

  TemporaryFolder folder_;
  Experiment experiment_;
  SweepOptions options_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_EXPERIMENT_SWEEP_FIXTURE_H_
