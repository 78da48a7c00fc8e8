#include "splitfusion/lib/tsdf/internal/leaf_table.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace splitfusion {
namespace internal {
namespace {

TEST(LeafTable, FindsEveryBlockAndNoOther) {
  std::mt19937 random(1);
  std::uniform_int_distribution<std::int32_t> place(-40, 25);
  std::map<LeafPlace, int> numbers;
  std::vector<LeafPlace> places;
  while (places.size() < 3000) {
    const LeafPlace p = {place(random), place(random), place(random)};
    if (!numbers.emplace(p, places.size() + 1).second) continue;
    places.push_back(p);
  }
  LeafTable table;
  for (std::size_t i = 0; i < places.size(); ++i) {
    table.Insert(places[i], static_cast<int>(i) + 1);
  }
  std::uniform_int_distribution<std::int32_t> wide(-100, 100);
  for (int i = 0; i < 20000; ++i) {
    const LeafPlace p = {wide(random), wide(random), wide(random)};
    const auto found = numbers.find(p);
    EXPECT_EQ(table.Find(p[0], p[1], p[2]),
              found == numbers.end() ? 0 : found->second);
  }
  for (const auto& [p, number] : numbers) {
    EXPECT_EQ(table.Find(p[0], p[1], p[2]), number);
  }
}

TEST(LeafTable, HoldsNothingWhereThereIsNothing) {
  const LeafTable table;
  EXPECT_EQ(table.Find(0, 0, 0), 0);
  EXPECT_EQ(table.Find(-5, 100000, -100000), 0);
}

}  // namespace
}  // namespace internal
}  // namespace splitfusion
