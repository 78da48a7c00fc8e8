#include "splitfusion/pipelines/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

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

void CheckWritable(const std::string& path) {
  if (!std::ofstream(path)) throw InputError(path + ": cannot be written");
}

int WaitFor(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
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
                     const std::string& log) {
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
  const int failure =
      posix_spawn(&pid, argv[0], actions.get(), nullptr, argv.data(), environ);
  if (failure != 0) {
    return {127, arguments.front() + ": " + std::strerror(failure)};
  }
  ChildResult result{WaitFor(pid), ""};
  result.last_error_line = LastLine(errors);
  return result;
}

}  // namespace splitfusion
