#include "splitfusion/lib/tracking/usual_misfit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace splitfusion {
namespace {

TEST(UsualMisfit, LetsEverythingPassBeforeTheFirstFrame) {
  EXPECT_TRUE(std::isinf(UsualMisfit(3).Highest()));
}

TEST(UsualMisfit, FollowsWhatIsUsual) {
  UsualMisfit misfit(3);
  misfit.Add(0.04);
  EXPECT_GT(misfit.Highest(), 0.1);
  EXPECT_LT(misfit.Highest(), 0.3);  // Another scene has 1.
  const double before = misfit.Highest();
  for (int i = 0; i < 30; ++i) misfit.Add(0.3);
  EXPECT_GT(misfit.Highest(), 0.8);
  for (int i = 0; i < 100; ++i) misfit.Add(0.04);
  EXPECT_NEAR(misfit.Highest(), before, 1e-3);
}

}  // namespace
}  // namespace splitfusion
