#include "splitfusion/lib/base/read_ahead.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

namespace splitfusion {
namespace {

class ReadAheadTest : public ::testing::TestWithParam<bool> {};

TEST_P(ReadAheadTest, GivesTheSeriesInOrder) {
  int made = 0;
  ReadAhead<int> items(
      [&]() -> std::optional<int> {
        if (made == 4) return std::nullopt;
        return made++;
      },
      GetParam());
  for (int i = 0; i < 4; ++i) EXPECT_EQ(items.Next(), i);
  EXPECT_FALSE(items.Next());
  EXPECT_FALSE(items.Next()) << "asked once more";
}

TEST_P(ReadAheadTest, AnErrorIsThrownForItsItem) {
  int made = 0;
  ReadAhead<int> items(
      [&]() -> std::optional<int> {
        if (made == 1) throw std::runtime_error("item 1 is broken");
        return made++;
      },
      GetParam());
  EXPECT_EQ(items.Next(), 0);
  EXPECT_THROW(items.Next(), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(AheadOrNot, ReadAheadTest, ::testing::Bool());

TEST(ReadAhead, MakesTheNextItemOnAnotherThread) {
  std::promise<void> second_begins;
  int made = 0;
  ReadAhead<std::thread::id> items(
      [&]() -> std::optional<std::thread::id> {
        if (++made == 2) second_begins.set_value();
        return std::this_thread::get_id();
      },
      /*ahead=*/true);
  EXPECT_NE(items.Next(), std::this_thread::get_id());
  second_begins.get_future().wait();  // Without being asked for.
}

}  // namespace
}  // namespace splitfusion
