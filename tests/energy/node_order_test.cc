#include "splitfusion/lib/energy/node_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

constexpr int kSide = 24;
constexpr int kNodes = kSide * kSide;

/// A grid whose nodes were born one far from the other.
std::vector<std::pair<int, int>> Grid() {
  const auto node = [](int x, int y) {
    return (y * kSide + x) * 25 % kNodes;  // Prime to the number of nodes.
  };
  std::vector<std::pair<int, int>> coupled;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      if (x > 0) coupled.emplace_back(node(x, y), node(x - 1, y));
      if (y > 0) coupled.emplace_back(node(x, y - 1), node(x, y));
    }
  }
  return coupled;
}

/// Entries below the diagonal of the Cholesky factor.
std::size_t FillIn(const std::vector<int>& places) {
  std::vector<std::set<int>> columns(kNodes);
  for (const auto& [a, b] : Grid()) {
    const auto [low, high] = std::minmax(places[a], places[b]);
    columns[low].insert(high);
  }
  std::size_t entries = 0;
  for (const std::set<int>& column : columns) {
    entries += column.size();
    if (column.empty()) continue;
    const int parent = *column.begin();
    columns[parent].insert(std::next(column.begin()), column.end());
  }
  return entries;
}

TEST(OrderNodes, GivesEveryNodeAPlaceAndLessFillInThanNone) {
  const std::size_t natural = FillIn(OrderNodes(kNodes, Grid(), "natural"));
  for (const char* ordering : {"amd", "nesdis"}) {
    const std::vector<int> places = OrderNodes(kNodes, Grid(), ordering);
    std::vector<int> sorted = places, all(kNodes);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(sorted, all) << ordering;
    EXPECT_LT(2 * FillIn(places), natural) << ordering;
    EXPECT_EQ(OrderNodes(kNodes, Grid(), ordering), places) << "again";
  }
}

TEST(OrderNodes, TakesWhatIsNotCoupledOrNotThere) {
  for (const char* ordering : {"amd", "nesdis", "natural"}) {
    EXPECT_EQ(OrderNodes(1, {}, ordering), std::vector<int>{0});
    EXPECT_EQ(OrderNodes(0, {}, ordering), std::vector<int>());
    EXPECT_EQ(OrderNodes(3, {}, ordering).size(), 3u);
  }
  EXPECT_THROW(OrderNodes(3, {}, "random"), OptionError);
}

}  // namespace
}  // namespace splitfusion
