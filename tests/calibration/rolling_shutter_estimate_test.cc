#include "splitfusion/lib/calibration/rolling_shutter_estimate.h"

#include <gtest/gtest.h>

#include "support/rolling_room.h"

namespace splitfusion {
namespace {

constexpr int kFrames = 40;

RollingShutterEstimate EstimateOf(const RollingRoom& room, int frames) {
  return EstimateRollingShutter(
      [&](int i) -> std::optional<Frame> { return room.At(i); }, frames,
      room.camera);
}

TEST(RollingShutterEstimate, FindsHowLongRowsTake) {
  const RollingShutterEstimate estimate = EstimateOf({0.025}, kFrames);
  EXPECT_TRUE(estimate.IsNeeded()) << estimate.Text();
  EXPECT_NEAR(estimate.seconds, 0.025, 0.003);
  EXPECT_NEAR(estimate.interval, RollingRoom::kInterval, 1e-9);
  EXPECT_EQ(EstimateOf({0.025}, kFrames).seconds, estimate.seconds);
}

TEST(RollingShutterEstimate, FindsNoneWhereRowsAreExposedAtOnce) {
  const RollingShutterEstimate estimate = EstimateOf({0}, kFrames);
  EXPECT_GE(estimate.pairs, 4);
  EXPECT_NEAR(estimate.seconds, 0, 0.003);
  EXPECT_FALSE(estimate.IsNeeded()) << estimate.Text();
}

TEST(RollingShutterEstimate, TooLittleTellsNothing) {
  const RollingRoom room{0.025};
  for (const int frames : {0, 1, 2, 3}) {
    EXPECT_FALSE(EstimateOf(room, frames).IsNeeded()) << frames;
  }
  const auto none = [](int) { return std::optional<Frame>(); };
  EXPECT_EQ(EstimateRollingShutter(none, kFrames, room.camera).pairs, 0);
  // A camera that stands still.
  const auto still = [&](int i) {
    Frame frame = room.At(3);
    frame.timestamp = RollingRoom::kInterval * i;
    return std::optional<Frame>(frame);
  };
  EXPECT_FALSE(EstimateRollingShutter(still, kFrames, room.camera).IsNeeded());
}

}  // namespace
}  // namespace splitfusion
