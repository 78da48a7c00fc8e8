#include "splitfusion/pipelines/batch.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/stopwatch.h"
#include "splitfusion/lib/report/run_directory.h"
#include "splitfusion/lib/report/run_paths.h"

namespace splitfusion {
namespace {

namespace fs = std::filesystem;

void MakeFolder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw InputError(folder + ": cannot be created (" + error.message() + ")");
  }
}

/// Records a child's end; true if it ended well.
bool Record(const ChildResult& child, BatchResult* result) {
  result->exit_code = child.exit_code;
  if (child.exit_code == 0) return true;
  result->error = child.last_error_line;
  if (result->error.empty() && child.exit_code > 128) {
    result->error = "ended by signal " + std::to_string(child.exit_code - 128);
  }
  return false;
}

bool Reconstruct(const BatchOptions& options, const StopRequest& stop,
                 BatchResult* result) {
  const BatchRun& run = result->run;
  const RunPaths paths(run.folder);
  result->skipped = !options.overwrite && IsComplete(paths);
  std::vector<std::string> arguments = {options.run_program, "--overwrite"};
  if (!options.overwrite) arguments.push_back("--keep_same");
  if (!run.option_file.empty()) {
    arguments.push_back("--flagfile=" + run.option_file);
  }
  // Last, so that they win over those of an earlier run's options.flags.
  arguments.push_back("--sequence=" + run.sequence_folder);
  arguments.push_back("--output=" + run.folder);
  return Record(RunChild(arguments, run.folder + "/run", stop), result);
}

void Evaluate(const BatchOptions& options, const StopRequest& stop,
              BatchResult* result) {
  const BatchRun& run = result->run;
  const RunPaths paths(run.folder);
  if (run.ground_truth.empty()) return;
  if (result->skipped && fs::exists(paths.Evaluation())) return;
  Record(RunChild({options.evaluate_program, "--run=" + run.folder,
                   "--ground_truth=" + run.ground_truth},
                  run.folder + "/evaluate", stop),
         result);
}

BatchResult RunOne(const BatchOptions& options, const StopRequest& stop,
                   const BatchRun& run) {
  BatchResult result;
  result.run = run;
  MakeFolder(run.folder);
  if (Reconstruct(options, stop, &result)) Evaluate(options, stop, &result);
  result.figures = ReadFigures(run.folder);
  return result;
}

/// Hands the runs of a plan to threads and collects the results.
class BatchQueue {
 public:
  BatchQueue(const BatchOptions& options, BatchCallback progress,
             StopRequest stop)
      : options_(options),
        progress_(std::move(progress)),
        stop_(std::move(stop)),
        plan_(PlanBatch(options)),
        results_(plan_.size()) {}

  std::vector<BatchResult> Run() {
    std::vector<std::thread> threads;
    threads.reserve(options_.jobs);
    for (int i = 0; i < options_.jobs; ++i) {
      threads.emplace_back([this] { Work(); });
    }
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return Finished();
  }

 private:
  void Work() {
    try {
      while (const std::optional<std::size_t> index = Take()) {
        Give(*index, RunOne(options_, stop_, plan_[*index]));
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex_);
      failure_ = std::current_exception();
    }
  }

  std::optional<std::size_t> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool stopped = stop_ && stop_() != Stop::kNo;
    if (failure_ || next_ == plan_.size() || stopped) return std::nullopt;
    return next_++;
  }

  void Give(std::size_t index, BatchResult result) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!result.skipped) ++executed_;
    ++done_;
    results_[index] = std::move(result);
    WriteBatchSummary(options_.output, Finished());
    if (!progress_) return;
    progress_({done_, static_cast<int>(plan_.size()), SecondsLeft(),
               *results_[index]});
  }

  double SecondsLeft() const {
    const double left = static_cast<double>(plan_.size()) - done_;
    return executed_ == 0 ? 0 : stopwatch_.Seconds() * left / executed_;
  }

  std::vector<BatchResult> Finished() const {
    std::vector<BatchResult> finished;
    for (const auto& result : results_) {
      if (result) finished.push_back(*result);
    }
    return finished;
  }

  const BatchOptions& options_;
  const BatchCallback progress_;
  const StopRequest stop_;
  const std::vector<BatchRun> plan_;
  const Stopwatch stopwatch_;
  std::mutex mutex_;  // Guards everything below.
  std::vector<std::optional<BatchResult>> results_;
  std::size_t next_ = 0;
  int done_ = 0;
  int executed_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<BatchResult> RunBatch(const BatchOptions& options,
                                  const BatchCallback& progress,
                                  const StopRequest& stop) {
  return BatchQueue(options, progress, stop).Run();
}

int CountFailed(const std::vector<BatchResult>& results) {
  return static_cast<int>(
      std::count_if(results.begin(), results.end(),
                    [](const auto& r) { return r.exit_code != 0; }));
}

}  // namespace splitfusion
