#include "splitfusion/lib/experiment/child_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <opencv2/core.hpp>
#include <sstream>
#include <thread>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/base/stopwatch.h"

namespace splitfusion {
namespace {

/// Between two looks at a child.
constexpr std::chrono::milliseconds kPollInterval(20);
/// Of stderr.
constexpr std::size_t kLastLines = 5;
/// Of a program that could not be started.
constexpr int kNotStarted = 127;
/// Of a process whose status was lost (SIGCHLD is ignored).
constexpr int kUnknownExit = 255;

void CheckWritable(const std::string& path) {
  if (!std::ofstream(path)) throw InputError(path + ": cannot be written");
}

/// All that the child needs between fork and exec, made before: there only
/// functions that are safe in a signal handler may be called.
struct Start {
  std::vector<char*> arguments;  ///< Ends with null.
  const char* output = nullptr;  ///< Path for stdout.
  const char* errors = nullptr;  ///< Path for stderr.
  pid_t parent = 0;              ///< This process.
};

void Redirect(const char* path, int flags, int descriptor) {
  const int file = open(path, flags | O_CLOEXEC, 0644);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(kNotStarted);
}

/// SIGTERM is ignored: Slurm and systemd send it to every process of a job, and
/// a child would take that and the SIGINT that follows from here for two.
void PrepareSignals() {
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  for (const int signal : {SIGINT, SIGPIPE}) {
    sigaction(signal, &action, nullptr);
  }
  action.sa_handler = SIG_IGN;
  sigaction(SIGTERM, &action, nullptr);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// In the child.
[[noreturn]] void Execute(const Start& start) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent may have ended before it could be tied to.
  if (getppid() != start.parent) _exit(kNotStarted);
  PrepareSignals();
  Redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  Redirect(start.output, O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  Redirect(start.errors, O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  execv(start.arguments[0], start.arguments.data());
  const char* const reason = std::strerror(errno);
  // A failure to write cannot be reported any more.
  if (write(STDERR_FILENO, reason, std::strlen(reason)) < 0) _exit(kNotStarted);
  _exit(kNotStarted);
}

/// CPU seconds of a process that runs; 0 if that cannot be told.
double CpuSeconds(pid_t pid) {
  std::ifstream stream("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(stream, text);
  // The name before the last parenthesis may hold anything.
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

/// Resident bytes of a process that runs.
std::int64_t ResidentBytes(pid_t pid) {
  std::ifstream stream("/proc/" + std::to_string(pid) + "/statm");
  std::int64_t all = 0, resident = 0;
  stream >> all >> resident;
  return resident * sysconf(_SC_PAGESIZE);
}

std::string Overrun(const std::string& what, double limit) {
  return cv::format("killed: over the limit of %g %s", limit, what.c_str());
}

/// Which limit a process is beyond; empty if none.
std::string BeyondLimit(pid_t pid, const ChildLimits& limits,
                        const Stopwatch& watch) {
  constexpr double kMinute = 60, kGigabyte = 1e9;
  if (limits.wall_seconds > 0 && watch.Seconds() > limits.wall_seconds) {
    return Overrun("minutes", limits.wall_seconds / kMinute);
  }
  if (limits.cpu_seconds > 0 && CpuSeconds(pid) > limits.cpu_seconds) {
    return Overrun("CPU minutes", limits.cpu_seconds / kMinute);
  }
  const auto bytes = limits.memory_bytes;
  if (bytes > 0 && ResidentBytes(pid) > bytes) {
    return Overrun("GB of memory", static_cast<double>(bytes) / kGigabyte);
  }
  return "";
}

/// The last lines that are not empty; of a line rewritten with '\r', what was
/// written last.
std::vector<std::string> LastLines(const std::string& path) {
  std::ifstream stream(path);
  std::deque<std::string> last;
  for (std::string line; std::getline(stream, line);) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    line.erase(0, line.rfind('\r') + 1);
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    last.push_back(line);
    if (last.size() > kLastLines) last.pop_front();
  }
  return {last.begin(), last.end()};
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) +
         1e-6 * static_cast<double>(time.tv_usec);
}

void SignalGroup(pid_t pid, int signal) {
  // Before the child has made its group it is alone.
  if (kill(-pid, signal) != 0) kill(pid, signal);
}

/// Waits for the end of a child; text of the limit that ended it, or empty.
std::string WaitFor(pid_t pid, const StopRequest& stop,
                    const ChildLimits& limits, ChildResult* result) {
  const Stopwatch watch;
  int status = 0;
  rusage usage = {};
  Stop told = Stop::kNo;
  std::string overrun;
  pid_t ended = 0;
  while ((ended = wait4(pid, &status, WNOHANG, &usage)) == 0) {
    const Stop wanted = stop ? stop() : Stop::kNo;
    if (wanted > told) {
      SignalGroup(pid, wanted == Stop::kAtOnce ? SIGKILL : SIGINT);
    }
    told = std::max(told, wanted);
    if (overrun.empty()) {
      overrun = BeyondLimit(pid, limits, watch);
      if (!overrun.empty()) SignalGroup(pid, SIGKILL);
    }
    std::this_thread::sleep_for(kPollInterval);
  }
  result->wall_seconds = watch.Seconds();
  result->cpu_seconds = Seconds(usage.ru_utime) + Seconds(usage.ru_stime);
  result->peak_memory_bytes = std::int64_t{usage.ru_maxrss} * 1024;
  result->exit_code = ended != pid          ? kUnknownExit
                      : WIFSIGNALED(status) ? 128 + WTERMSIG(status)
                                            : WEXITSTATUS(status);
  return overrun;
}

}  // namespace

std::string ChildResult::LastLine() const {
  return last_lines.empty() ? "" : last_lines.back();
}

ChildResult RunChild(const std::vector<std::string>& arguments,
                     const std::string& log, const StopRequest& stop,
                     const ChildLimits& limits) {
  const std::string output = log + ".log";
  const std::string errors = log + ".err.log";
  CheckWritable(output);
  CheckWritable(errors);
  Start start;
  for (const std::string& argument : arguments) {
    start.arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  start.arguments.push_back(nullptr);
  start.output = output.c_str();
  start.errors = errors.c_str();
  start.parent = getpid();
  const pid_t pid = fork();
  if (pid == 0) Execute(start);
  if (pid < 0) {
    return {kNotStarted, {arguments.front() + ": " + std::strerror(errno)}};
  }
  ChildResult result;
  const std::string overrun = WaitFor(pid, stop, limits, &result);
  result.last_lines = LastLines(errors);
  if (!overrun.empty()) {
    result.last_lines.push_back(overrun);
  } else if (result.exit_code > 128 && result.exit_code < kUnknownExit) {
    result.last_lines.push_back("ended by signal " +
                                std::to_string(result.exit_code - 128));
  } else if (result.exit_code == kNotStarted && !result.last_lines.empty()) {
    result.last_lines.back() =
        arguments.front() + ": " + result.last_lines.back();
  } else if (result.exit_code != 0 && result.last_lines.empty()) {
    result.last_lines = {"exit code " + std::to_string(result.exit_code) +
                         ", without a word"};
  }
  return result;
}

}  // namespace splitfusion
