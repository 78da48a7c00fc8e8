#ifndef SPLITFUSION_TESTS_SUPPORT_EXPECT_REFUSED_H_
#define SPLITFUSION_TESTS_SUPPORT_EXPECT_REFUSED_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "support/program.h"

namespace splitfusion {

/// Expects that a program ends with 2, nothing on stdout and one line on stderr
/// that says `text`.
inline void ExpectRefused(const std::string& program,
                          const std::string& arguments,
                          const std::string& text) {
  const ProgramResult result = RunProgram(program, arguments);
  EXPECT_EQ(result.exit_code, 2) << program << " " << arguments;
  EXPECT_EQ(result.output, "");
  EXPECT_THAT(result.errors, testing::HasSubstr(text));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1)
      << result.errors;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_EXPECT_REFUSED_H_
