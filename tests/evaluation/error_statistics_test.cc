#include "splitfusion/lib/evaluation/error_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splitfusion {
namespace {

TEST(Summarize, KnowsItsStatistics) {
  const ErrorStatistics s = Summarize({4, 1, 3, 2});
  EXPECT_EQ(s.count, 4);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(30.0 / 4));
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.p90, 3.7);
  EXPECT_DOUBLE_EQ(s.max, 4);
}

TEST(Summarize, OfNothingIsZero) {
  EXPECT_EQ(Summarize({}).count, 0);
  EXPECT_EQ(Summarize({}).rmse, 0);
  EXPECT_EQ(FractionWithin({}, 1), 0);
}

TEST(FractionWithin, IncludesTheThreshold) {
  EXPECT_DOUBLE_EQ(FractionWithin({1, 2, 3, 4}, 2), 0.5);
}

}  // namespace
}  // namespace splitfusion
