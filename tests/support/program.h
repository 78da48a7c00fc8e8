#ifndef SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_
#define SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_

#include <sys/types.h>

#include <string>

#include "support/temporary_folder.h"

namespace splitfusion {

/// What a program said and how it ended.
struct ProgramResult {
  int exit_code = 0;   ///< -1 if it did not end by itself.
  std::string output;  ///< On stdout.
  std::string errors;  ///< On stderr.
};

/// Whether a program of the build lies beside the test program.
bool HasProgram(const std::string& name);

/// Runs a program of the build; `arguments` as one would type them.
/// `environment`: variables that it has beside those of the test, "NAME=value".
ProgramResult RunProgram(const std::string& name, const std::string& arguments,
                         const std::string& environment = "");

/// A program of the build that runs beside the test, alone in its process
/// group.
class RunningProgram {
 public:
  /// Starts it; `arguments` as one would type them.
  RunningProgram(const std::string& name, const std::string& arguments);
  /// Ends it if it still runs.
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Whether it has not ended yet.
  bool Runs();
  /// Sends it a signal, and nobody else.
  void Send(int signal) const;
  /// Waits for its end.
  ProgramResult Wait();

 private:
  TemporaryFolder folder_;
  pid_t pid_ = 0;
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_
