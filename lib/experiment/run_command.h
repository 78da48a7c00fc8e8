#ifndef SPLITFUSION_LIB_EXPERIMENT_RUN_COMMAND_H_
#define SPLITFUSION_LIB_EXPERIMENT_RUN_COMMAND_H_

#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "splitfusion/lib/experiment/task.h"
#include "splitfusion/lib/report/run_identity.h"

namespace splitfusion {

/// Key that chooses another sf_run instead of being an option of it.
inline constexpr const char* kRunProgramKey = "run_program";

/// Makes and asks the commands that run tasks.
class RunCommand {
 public:
  /// @param run_program path of sf_run, for tasks that set no other one.
  /// @param threads of a run that sets none; 0 = sf_run's default.
  RunCommand(std::string run_program, int threads);

  /// Program and options of a task, without --sequence, --output and what
  /// becomes of an earlier result. Repeats above 0 have their voxels shifted.
  ///
  /// @throw InputError if the voxels are needed and sf_run does not tell them.
  std::vector<std::string> Options(const Task& task) const;

  /// The command that runs a task into a run directory.
  std::vector<std::string> Run(const Task& task, const std::string& run,
                               bool keep_same) const;

  /// What decides a task's result: the answer of `sf_run --print_identity`.
  ///
  /// @throw InputError with the last line of sf_run if that refuses.
  RunIdentity Ask(const Task& task) const;

  /// Whether sf_run takes the options of all tasks, each set of options asked
  /// once, on the first sequence that can be read.
  ///
  /// @throw InputError with the options and the last line of sf_run if it does
  ///     not.
  void CheckOptions(const std::vector<Task>& tasks);

  /// How the options and the program of a finished run differ from what they
  /// were at CheckOptions(), as where a flagfile was edited meanwhile; empty if
  /// they do not, or if nothing is known of them.
  std::string ChangesSincePlanned(const Task& task,
                                  const RunIdentity& identity) const;

 private:
  std::vector<std::string> Plain(const Task& task) const;
  RunIdentity AskPlain(const Task& task) const;
  bool CanBeRead(const Task& task) const;

  std::string run_program_;
  int threads_;
  /// By the options' text: parts but for the input.
  std::map<std::string, NamedValues> planned_;
  mutable std::mutex mutex_;
  /// Identities of undisturbed tasks, by the options' text and the sequence.
  mutable std::map<std::string, RunIdentity> known_;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_RUN_COMMAND_H_
