#include "splitfusion/lib/base/median.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(Median, IsTheMiddleValue) {
  EXPECT_EQ(Median<double>({}), 0);
  EXPECT_EQ(Median<double>({3, 1, 2}), 2);
  EXPECT_EQ(Median<double>({4, 1, 2, 3}), 2.5);
}

}  // namespace
}  // namespace splitfusion
