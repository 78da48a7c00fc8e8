#ifndef SPLITFUSION_PIPELINES_CHILD_PROCESS_H_
#define SPLITFUSION_PIPELINES_CHILD_PROCESS_H_

#include <functional>
#include <string>
#include <vector>

namespace splitfusion {

/// How a child process ended.
struct ChildResult {
  /// Exit code; 128 + signal if a signal ended it, 127 if it could not start.
  int exit_code = 0;
  std::string last_error_line;  ///< Last line on stderr that is not empty.
};

/// Whether something that runs should stop.
enum class Stop {
  kNo,         ///< It should go on.
  kWhenReady,  ///< After it has written what it has.
  kAtOnce,     ///< Whatever is lost by it.
};

/// Asked now and then while a child runs.
using StopRequest = std::function<Stop()>;

/// Runs a program without a shell, waits for it, and captures what it says. The
/// child is in a process group of its own, so that Ctrl-C on the terminal does
/// not reach it; once `stop` (may be empty) says kWhenReady it gets one SIGINT,
/// and is waited for as before; at kAtOnce it is killed.
///
/// @param arguments the program's path, then its arguments.
/// @param log base path: stdout goes to `log`.log, stderr to `log`.err.log.
/// @throw InputError if the log files cannot be written.
ChildResult RunChild(const std::vector<std::string>& arguments,
                     const std::string& log, const StopRequest& stop = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_CHILD_PROCESS_H_
