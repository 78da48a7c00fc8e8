#include "splitfusion/lib/experiment/run_command.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/surface_energies.h"
#include "splitfusion/lib/experiment/child_process.h"
#include "splitfusion/lib/experiment/repeats.h"
#include "splitfusion/lib/experiment/scratch_folder.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

std::string JoinedOptions(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& option : options) text += option + '\n';
  return text;
}

/// Options and program, which are the same for all sequences.
NamedValues WithoutInput(const NamedValues& parts) {
  NamedValues rest;
  for (const auto& [name, value] : parts) {
    if (name.rfind("input.", 0) != 0) rest[name] = value;
  }
  return rest;
}

/// Runs `sf_run --print_identity`.
RunIdentity AskProgram(std::vector<std::string> arguments,
                       const std::string& sequence) {
  const ScratchFolder folder;
  arguments.push_back("--print_identity");
  arguments.push_back("--sequence=" + sequence);
  arguments.push_back("--output=" + folder.path() + "/run");
  const ChildResult child = RunChild(arguments, folder.path() + "/ask");
  if (child.exit_code != 0) throw InputError(child.LastLine());
  try {
    const Json json = Json::parse(std::ifstream(folder.path() + "/ask.log"));
    return {json.at("identity_parts").get<NamedValues>(),
            json.at("outputs").get<NamedValues>()};
  } catch (const Json::exception&) {
    throw InputError(arguments.front() +
                     " --print_identity: expected JSON with identity_parts");
  }
}

}  // namespace

RunCommand::RunCommand(std::string run_program, int threads)
    : run_program_(std::move(run_program)), threads_(threads) {}

std::vector<std::string> RunCommand::Plain(const Task& task) const {
  const std::string* own = task.settings.Find(kRunProgramKey);
  std::vector<std::string> arguments = {own ? *own : run_program_};
  // First, so that everything else wins over it.
  if (const std::string* file = task.settings.Find("flagfile")) {
    arguments.push_back("--flagfile=" + *file);
  }
  if (threads_ > 0)
    arguments.push_back("--threads=" + std::to_string(threads_));
  Settings terms;
  for (const auto& [key, value] : task.settings.entries()) {
    if (key == kRunProgramKey || key == "flagfile") continue;
    if (IsTermKey(key)) {
      terms.Set(key, value);
    } else {
      arguments.push_back("--" + key + "=" + value);
    }
  }
  if (!terms.empty()) arguments.push_back("--set=" + SettingsText(terms));
  return arguments;
}

std::vector<std::string> RunCommand::Options(const Task& task) const {
  std::vector<std::string> arguments = Plain(task);
  if (task.repeat == 0) return arguments;
  const Settings shifted = ShiftVoxels(AskPlain(task).parts, task.repeat);
  for (const auto& [key, value] : shifted.entries()) {
    arguments.push_back("--" + key + "=" + value);
  }
  return arguments;
}

std::vector<std::string> RunCommand::Run(const Task& task,
                                         const std::string& run,
                                         bool keep_same) const {
  std::vector<std::string> arguments = Options(task);
  arguments.push_back("--overwrite");
  if (keep_same) arguments.push_back("--keep_same");
  arguments.push_back("--sequence=" + task.sequence_folder);
  arguments.push_back("--output=" + run);
  return arguments;
}

RunIdentity RunCommand::AskPlain(const Task& task) const {
  const std::vector<std::string> arguments = Plain(task);
  const std::string key =
      task.sequence_folder + '\n' + JoinedOptions(arguments);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
  }
  RunIdentity identity = AskProgram(arguments, task.sequence_folder);
  const std::lock_guard<std::mutex> lock(mutex_);
  return known_[key] = std::move(identity);
}

RunIdentity RunCommand::Ask(const Task& task) const {
  if (task.repeat == 0) return AskPlain(task);
  return AskProgram(Options(task), task.sequence_folder);
}

bool RunCommand::CanBeRead(const Task& task) const try {
  Task bare = task;
  bare.settings = Settings();
  if (const std::string* own = task.settings.Find(kRunProgramKey)) {
    bare.settings.Set(kRunProgramKey, *own);
  }
  AskPlain(bare);
  return true;
} catch (const InputError&) {
  return false;
}

void RunCommand::CheckOptions(const std::vector<Task>& tasks) {
  for (const Task& task : tasks) {
    const std::string options = JoinedOptions(Plain(task));
    if (task.repeat > 0 || planned_.count(options) > 0) continue;
    try {
      planned_[options] = WithoutInput(AskPlain(task).parts);
    } catch (const InputError& error) {
      // A sequence that cannot be read is the failure of its own runs.
      if (CanBeRead(task)) {
        throw InputError("options \"" + SettingsText(task.settings) +
                         "\": " + error.what());
      }
    }
  }
}

std::string RunCommand::ChangesSincePlanned(const Task& task,
                                            const RunIdentity& identity) const {
  const auto found = planned_.find(JoinedOptions(Plain(task)));
  if (found == planned_.end()) return "";
  return DifferencesBeyondRepeats(found->second, WithoutInput(identity.parts));
}

}  // namespace splitfusion
