#include "splitfusion/cost_functions/builtin_terms.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(BuiltinTerms, AreAValueToWhichOneAddsOnesOwn) {
  TermRegistry mine = BuiltinTerms();
  mine.Register("again", [] { return BuiltinTerms().Create("arap"); });
  EXPECT_EQ(mine.Names().size(), BuiltinTerms().Names().size() + 1);
  ExpectInputError([&] { mine.Register("arap", {}); },
                   "energy term 'arap': already registered");
}

}  // namespace
}  // namespace splitfusion
