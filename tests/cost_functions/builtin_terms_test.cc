#include "splitfusion/cost_functions/builtin_terms.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(BuiltinTerms, AreAValueToWhichOneAddsOnesOwn) {
  TermRegistry mine = BuiltinTerms();
  mine.Register("again", [] { return BuiltinTerms().Make("arap"); });
  EXPECT_EQ(mine.names().size(), BuiltinTerms().names().size() + 1);
  ExpectInputError([&] { mine.Register("arap", {}); },
                   "term 'arap': already registered");
}

}  // namespace
}  // namespace splitfusion
