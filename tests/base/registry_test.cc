#include "splitfusion/lib/base/registry.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(Registry, MakesByNameAndListsInOrder) {
  Registry<int, int> registry("number");
  registry.Register("twice",
                    [](int n) { return std::make_unique<int>(2 * n); });
  registry.Register("same", [](int n) { return std::make_unique<int>(n); });
  EXPECT_EQ(*registry.Make("twice", 4), 8);
  EXPECT_EQ(*registry.Make("same", 4), 4);
  EXPECT_EQ(registry.names(), (std::vector<std::string>{"twice", "same"}));
}

TEST(Registry, RefusesWhatIsUnknownOrTaken) {
  Registry<int> registry("number");
  for (const char* name : {"one", "two", "three"}) {
    registry.Register(name, [] { return std::make_unique<int>(0); });
  }
  ExpectInputError([&] { registry.Make("four"); },
                   "number = four: expected one, two or three");
  ExpectInputError([&] { registry.Check(""); }, "number = '': expected one");
  EXPECT_NO_THROW(registry.Check("two"));
  ExpectInputError([&] { registry.Register("two", {}); },
                   "number 'two': already registered");
}

}  // namespace
}  // namespace splitfusion
