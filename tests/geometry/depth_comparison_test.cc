#include "splitfusion/lib/geometry/depth_comparison.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(DepthTolerance, GrowsWithTheNoiseOfTheSensor) {
  const DepthTolerance<double> tolerance = {0.02, 3};
  EXPECT_DOUBLE_EQ(tolerance.At(0.4, DepthNoise()), 0.02 + 3 * 0.0012);
  EXPECT_DOUBLE_EQ(tolerance.At(2.4, DepthNoise()),
                   0.02 + 3 * (0.0012 + 0.0019 * 4));
}

TEST(ClassifyDepth, ComparesWhatIsSeenWithThePoint) {
  EXPECT_EQ(ClassifyDepth(2.04f, 2.0f, 0.05f), DepthState::kObserved);
  EXPECT_EQ(ClassifyDepth(1.96f, 2.0f, 0.05f), DepthState::kObserved);
  EXPECT_EQ(ClassifyDepth(1.94f, 2.0f, 0.05f), DepthState::kOccluded);
  EXPECT_EQ(ClassifyDepth(2.06f, 2.0f, 0.05f), DepthState::kFree);
}

TEST(ClassifyDepth, SaysNothingWithoutDepth) {
  EXPECT_EQ(ClassifyDepth(0.0f, 2.0f, 0.05f), DepthState::kUnmeasured);
  EXPECT_EQ(ClassifyDepth(2.0f, 0.0f, 0.05f), DepthState::kUnmeasured);
}

TEST(IsDepthJump, IsTheSameFromBothSides) {
  EXPECT_FALSE(IsDepthJump(2.0f, 2.04f, 0.05f));
  EXPECT_TRUE(IsDepthJump(2.0f, 2.06f, 0.05f));
  EXPECT_TRUE(IsDepthJump(2.06f, 2.0f, 0.05f));
}

}  // namespace
}  // namespace splitfusion
