#include "splitfusion/cost_functions/builtin_terms.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(BuiltinTerms, AreTheTwoOfThePaperAndColour) {
  const TermRegistry registry = BuiltinTerms();
  EXPECT_EQ(registry.Names(),
            (std::vector<std::string>{"arap", "color", "point_to_plane"}));
  EXPECT_TRUE(registry.Create("arap")->is_prior());
  EXPECT_FALSE(registry.Create("point_to_plane")->is_prior());
}

TEST(BuiltinTerms, AreAValueToWhichOneAddsOnesOwn) {
  TermRegistry mine = BuiltinTerms();
  mine.Register("again", [] { return BuiltinTerms().Create("arap"); });
  EXPECT_EQ(mine.Names().size(), 4u);
  EXPECT_EQ(BuiltinTerms().Names().size(), 3u);
  ExpectInputError([&] { mine.Register("arap", {}); },
                   "energy term 'arap': already registered");
}

}  // namespace
}  // namespace splitfusion
