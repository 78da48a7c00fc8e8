#ifndef SPLITFUSION_PIPELINES_CHILD_PROCESS_H_
#define SPLITFUSION_PIPELINES_CHILD_PROCESS_H_

#include <string>
#include <vector>

namespace splitfusion {

/// How a child process ended.
struct ChildResult {
  /// Exit code; 128 + signal if a signal ended it, 127 if it could not start.
  int exit_code = 0;
  std::string last_error_line;  ///< Last line on stderr that is not empty.
};

/// Runs a program without a shell, waits for it, and captures what it says.
///
/// @param arguments the program's path, then its arguments.
/// @param log base path: stdout goes to `log`.log, stderr to `log`.err.log.
/// @throw InputError if the log files cannot be written.
ChildResult RunChild(const std::vector<std::string>& arguments,
                     const std::string& log);

}  // namespace splitfusion

#endif  // SPLITFUSION_PIPELINES_CHILD_PROCESS_H_
