#ifndef SPLITFUSION_LIB_EXPERIMENT_CHILD_PROCESS_H_
#define SPLITFUSION_LIB_EXPERIMENT_CHILD_PROCESS_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace splitfusion {

/// What a child process may use; it is killed beyond. 0 = no limit.
struct ChildLimits {
  double wall_seconds = 0;        ///< Of the clock.
  double cpu_seconds = 0;         ///< Of all its threads together.
  std::int64_t memory_bytes = 0;  ///< Resident.
};

/// How a child process ended.
struct ChildResult {
  /// Exit code; 128 + signal if a signal ended it, 127 if it could not start.
  int exit_code = 0;
  /// Its last lines on stderr that are not empty, the last one last; or what
  /// else ended it; never empty if it failed.
  std::vector<std::string> last_lines;
  double wall_seconds = 0;             ///< Of the clock.
  double cpu_seconds = 0;              ///< User and system.
  std::int64_t peak_memory_bytes = 0;  ///< Largest resident size.

  /// The last of `last_lines`; empty if there is none.
  std::string LastLine() const;
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
/// not reach it, and starts with SIGTERM ignored; once `stop` (may be empty)
/// says kWhenReady it gets one SIGINT, and is waited for as before; at kAtOnce
/// it is killed. It is also killed when this process ends, however that comes
/// about.
///
/// @param arguments the program's path, then its arguments.
/// @param log base path: stdout goes to `log`.log, stderr to `log`.err.log.
/// @throw InputError if the log files cannot be written.
ChildResult RunChild(const std::vector<std::string>& arguments,
                     const std::string& log, const StopRequest& stop = {},
                     const ChildLimits& limits = {});

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EXPERIMENT_CHILD_PROCESS_H_
