#ifndef SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_
#define SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_

#include <string>

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
ProgramResult RunProgram(const std::string& name, const std::string& arguments);

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_PROGRAM_H_
