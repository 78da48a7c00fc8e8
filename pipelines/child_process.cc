#include "splitfusion/pipelines/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// Between two looks at a child.
constexpr std::chrono::milliseconds kPollInterval(20);

/// Where the child's streams go; released with the object.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;

  void Open(int descriptor, const std::string& path, int flags) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, path.c_str(), flags,
                                     0644);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

/// How the child starts; released with the object.
class Attributes {
 public:
  /// A process group of its own, and the default disposition of the signals
  /// that ask it to stop.
  Attributes() {
    posix_spawnattr_init(&attributes_);
    posix_spawnattr_setpgroup(&attributes_, 0);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  }
  ~Attributes() { posix_spawnattr_destroy(&attributes_); }
  Attributes(const Attributes&) = delete;
  Attributes& operator=(const Attributes&) = delete;

  const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_;
};

void CheckWritable(const std::string& path) {
  if (!std::ofstream(path)) throw InputError(path + ": cannot be written");
}

/// Of a process whose status somebody else took (SIGCHLD is ignored).
constexpr int kUnknownExit = 255;

int WaitFor(pid_t pid, const StopRequest& stop) {
  int status = 0;
  Stop told = Stop::kNo;
  pid_t ended = 0;
  while ((ended = waitpid(pid, &status, WNOHANG)) == 0) {
    const Stop wanted = stop ? stop() : Stop::kNo;
    if (wanted > told) kill(pid, wanted == Stop::kAtOnce ? SIGKILL : SIGINT);
    told = std::max(told, wanted);
    std::this_thread::sleep_for(kPollInterval);
  }
  if (ended != pid) return kUnknownExit;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Last non-empty line; of a line rewritten with '\r', what was written last.
std::string LastLine(const std::string& path) {
  std::ifstream stream(path);
  std::string line, last;
  while (std::getline(stream, line)) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    line.erase(0, line.rfind('\r') + 1);
    if (line.find_first_not_of(" \t") != std::string::npos) last = line;
  }
  return last;
}

}  // namespace

ChildResult RunChild(const std::vector<std::string>& arguments,
                     const std::string& log, const StopRequest& stop) {
  const std::string output = log + ".log";
  const std::string errors = log + ".err.log";
  CheckWritable(output);
  CheckWritable(errors);
  FileActions actions;
  actions.Open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.Open(STDOUT_FILENO, output, O_WRONLY | O_CREAT | O_TRUNC);
  actions.Open(STDERR_FILENO, errors, O_WRONLY | O_CREAT | O_TRUNC);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  pid_t pid = 0;
  const int failure = posix_spawn(&pid, argv[0], actions.get(),
                                  Attributes().get(), argv.data(), environ);
  if (failure != 0) {
    return {127, arguments.front() + ": " + std::strerror(failure)};
  }
  ChildResult result{WaitFor(pid, stop), ""};
  result.last_error_line = LastLine(errors);
  return result;
}

}  // namespace splitfusion
