#include <gtest/gtest.h>

#include "splitfusion/pipelines/split_fusion.h"
#include "support/rolling_room.h"

namespace splitfusion {
namespace {

/// Mean distance of the camera from where it was with the middle rows, metres.
double TrackingError(const RollingRoom& room, double rolling_shutter) {
  constexpr int kFrames = 25;
  SplitFusion fusion(room.camera, PipelineOptions(), LabelTable(), nullptr);
  fusion.set_rolling_shutter(rolling_shutter);
  double sum = 0;
  for (int i = 0; i < kFrames; ++i) {
    fusion.ProcessFrame(room.At(i));
    const Rigid3d expected = RollingRoom::PoseAt(0).inverse() *
                             RollingRoom::PoseAt(RollingRoom::kInterval * i);
    sum += (fusion.trajectory().back().world_from_camera.translation() -
            expected.translation())
               .norm();
  }
  return sum / kFrames;
}

TEST(RollingShutterRun, TheCameraIsWhereItWasWithTheMiddleRow) {
  const double undone = TrackingError({0.025}, 0.025);
  EXPECT_LT(undone, 0.5 * TrackingError({0.025}, 0));
  EXPECT_LT(undone, 0.01);
}

}  // namespace
}  // namespace splitfusion
