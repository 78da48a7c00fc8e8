#ifndef SPLITFUSION_TESTS_SUPPORT_EXPECT_INPUT_ERROR_H_
#define SPLITFUSION_TESTS_SUPPORT_EXPECT_INPUT_ERROR_H_

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {

/// Expects an InputError whose message contains `part`.
inline void ExpectInputError(const std::function<void()>& action,
                             const std::string& part) {
  try {
    action();
    ADD_FAILURE() << "no InputError with '" << part << "'";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
        << error.what();
  }
}

}  // namespace splitfusion

#endif  // SPLITFUSION_TESTS_SUPPORT_EXPECT_INPUT_ERROR_H_
