#include "splitfusion/lib/experiment/settings.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(Settings, ValuesWithSeparatorsAreQuoted) {
  const std::string text =
      R"t(solver=ceres; terms="p(weight=1,loss=tukey) a(w=""8"");"; a = 1)t";
  const Settings settings = ParseSettings(text, "set");
  ASSERT_EQ(settings.entries().size(), 3u);
  EXPECT_EQ(*settings.Find("terms"), R"t(p(weight=1,loss=tukey) a(w="8");)t");
  EXPECT_EQ(*settings.Find("a"), "1");
  EXPECT_EQ(settings.Find("b"), nullptr);
  EXPECT_EQ(ParseSettings(SettingsText(settings), "set").entries(),
            settings.entries());
}

TEST(Settings, AGridHasSeveralValuesAKey) {
  const auto axes = ParseGrid(
      R"t(terms.arap.weight=4,8; terms="a(b=1,c=2)","d; e";)t", "grid");
  ASSERT_EQ(axes.size(), 2u);
  EXPECT_EQ(axes[0].key, "terms.arap.weight");
  EXPECT_EQ(axes[0].values, (std::vector<std::string>{"4", "8"}));
  EXPECT_EQ(axes[1].values, (std::vector<std::string>{"a(b=1,c=2)", "d; e"}));
}

TEST(Settings, SaysWhatIsWrong) {
  ExpectInputError([] { ParseSettings("a", "set"); }, "KEY=VALUE");
  ExpectInputError([] { ParseSettings("a=1,2", "set"); }, "double quotes");
  ExpectInputError([] { ParseSettings("a=1; a=2", "set"); }, "twice");
  ExpectInputError([] { ParseSettings("--a=1", "set"); }, "flag's name");
  ExpectInputError([] { ParseSettings("a=\"1", "set"); }, "quote");
  for (const char* grid : {"a=", "a=1,,2", "a=1,"}) {
    ExpectInputError([&] { ParseGrid(grid, "grid"); }, "separated by commas");
  }
  EXPECT_EQ(ParseGrid("a=1,\"\"", "grid")[0].values.back(), "");
  ExpectInputError([] { ParseGrid("a=", "grid"); }, "values");
}

}  // namespace
}  // namespace splitfusion
