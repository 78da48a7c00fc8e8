#include "splitfusion/lib/model/observe_surface.h"

#include <gtest/gtest.h>

#include "support/sample_depth.h"

namespace splitfusion {
namespace {

TEST(ObserveSurface, OwnPixelsWriteOthersCarveUncertainOnesDoNothing) {
  const PinholeCamera camera = SmallCamera();
  LiveView live =
      MakeLiveView(camera, WallDepth(camera, 1), PlainColor(camera, {1, 2, 3}));
  live.labels.colRange(0, 80).setTo(4);
  live.uncertain.colRange(20, 30).setTo(255);
  live.edges.colRange(100, 110).setTo(255);
  const DepthObservation observed = ObserveSurface(live, 4);
  for (int u = 0; u < camera.width; ++u) {
    const bool none = (u >= 20 && u < 30) || (u >= 100 && u < 110);
    const PixelRole expected = none     ? PixelRole::kNone
                               : u < 80 ? PixelRole::kWrite
                                        : PixelRole::kCarve;
    EXPECT_EQ(observed.role(60, u), static_cast<int>(expected)) << u;
  }
  EXPECT_EQ(observed.depth.data, live.depth.data);
  EXPECT_EQ(observed.weight.data, live.confidence.data);
  EXPECT_EQ(observed.color.data, live.color.data);
  EXPECT_TRUE(observed.places.empty());
}

}  // namespace
}  // namespace splitfusion
