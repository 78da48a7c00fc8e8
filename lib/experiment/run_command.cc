#include "splitfusion/lib/experiment/run_command.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/experiment/child_process.h"
#include "splitfusion/lib/experiment/design.h"
#include "splitfusion/lib/experiment/scratch_folder.h"

namespace splitfusion {
namespace {

using Json = nlohmann::ordered_json;

bool IsTermKey(const std::string& key) { return key.rfind("terms.", 0) == 0; }

double ShiftFactor(const std::string& key, int repeat) {
  const double share =
      StableUniform("repeat " + std::to_string(repeat) + " " + key);
  // 1 to 9 millionths, up or down.
  const double size = 1 + 8 * std::abs(2 * share - 1);
  return 1 + (share < 0.5 ? -1e-6 : 1e-6) * size;
}

std::string JoinedOptions(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& option : options) text += option + '\n';
  return text;
}

/// Runs `sf_run --print_identity`.
RunIdentity AskProgram(std::vector<std::string> arguments,
                       const std::string& sequence) {
  const ScratchFolder folder;
  arguments.push_back("--print_identity");
  arguments.push_back("--sequence=" + sequence);
  arguments.push_back("--output=" + folder.path() + "/run");
  const ChildResult child = RunChild(arguments, folder.path() + "/ask");
  if (child.exit_code != 0) {
    throw InputError(child.last_lines.empty()
                         ? arguments.front() + " --print_identity: failed"
                         : child.LastLine());
  }
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

Settings ShiftVoxels(const NamedValues& parts, int repeat) {
  Settings settings;
  if (repeat == 0) return settings;
  for (const char* key : {"object_voxel", "background_voxel"}) {
    const auto found = parts.find(key);
    const double size =
        found == parts.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
    if (!(size > 0)) {
      throw InputError(std::string("--repeat: expected sf_run --print_identity "
                                   "to tell its ") +
                       key);
    }
    char text[48];
    std::snprintf(text, sizeof(text), "%.12g", size * ShiftFactor(key, repeat));
    settings.Set(key, text);
  }
  return settings;
}

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

void RunCommand::CheckOptions(const std::vector<Task>& tasks) const {
  std::set<std::string> checked;
  for (const Task& task : tasks) {
    const std::string options = JoinedOptions(Plain(task));
    if (task.repeat > 0 || checked.count(options) > 0) continue;
    try {
      AskPlain(task);
      checked.insert(options);
    } catch (const InputError&) {
      // A sequence that cannot be read is the failure of its own runs.
      if (CanBeRead(task)) throw;
    }
  }
}

}  // namespace splitfusion
