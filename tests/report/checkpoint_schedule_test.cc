#include "splitfusion/lib/report/checkpoint_schedule.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(CheckpointSchedule, CountsFrames) {
  CheckpointSchedule schedule(3);
  for (int round = 0; round < 2; ++round) {
    EXPECT_FALSE(schedule.IsDue(1000));
    EXPECT_FALSE(schedule.IsDue(2000));
    EXPECT_TRUE(schedule.IsDue(0));
    schedule.Saved(5);
  }
}

TEST(CheckpointSchedule, CostsAFiftiethOfTheTimeByItself) {
  CheckpointSchedule schedule(0);
  EXPECT_FALSE(schedule.IsDue(9));
  EXPECT_TRUE(schedule.IsDue(10));
  schedule.Saved(0.1);
  EXPECT_FALSE(schedule.IsDue(9));
  EXPECT_TRUE(schedule.IsDue(10));
  schedule.Saved(1);
  EXPECT_FALSE(schedule.IsDue(49));
  EXPECT_TRUE(schedule.IsDue(50));
}

TEST(CheckpointSchedule, IsSwitchedOff) {
  CheckpointSchedule schedule(-1);
  EXPECT_FALSE(schedule.IsDue(1e9));
}

}  // namespace
}  // namespace splitfusion
