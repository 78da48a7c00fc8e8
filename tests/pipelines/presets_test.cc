#include "splitfusion/pipelines/presets.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/expect_input_error.h"
#include "support/synthetic_run.h"

namespace splitfusion {
namespace {

/// Surfaces after some frames, as "kind" by id order.
std::vector<std::string> KindsOf(const std::string& preset) {
  PipelineOptions options;
  ApplyPreset(preset, &options);
  options.Check();
  SyntheticRun run(SyntheticRun::Quick(), options);
  for (int i = 0; i < 2; ++i) {
    for (const SurfaceReport& surface : run.Next().surfaces) {
      if (surface.id == 0) {
        EXPECT_NE(ToString(surface.state), "lost")
            << preset << ": " << surface.reason;
      }
    }
  }
  std::vector<std::string> kinds;
  for (const auto& [id, surface] : run.fusion().surfaces()) {
    kinds.push_back(ToString(surface->kind()));
  }
  return kinds;
}

TEST(Presets, NamesAreTheMethodAndItsBaselines) {
  EXPECT_EQ(PresetNames(), (std::vector<std::string>{
                               "background_only", "cofusion", "dynamicfusion",
                               "kinectfusion", "online", "splitfusion"}));
  PipelineOptions options;
  ExpectInputError([&] { ApplyPreset("elasticfusion", &options); },
                   "preset = elasticfusion: expected background_only, "
                   "cofusion, dynamicfusion, kinectfusion, online, "
                   "splitfusion");
}

TEST(Presets, SplitFusionHasARigidRoomAndNonRigidThings) {
  const std::vector<std::string> kinds = KindsOf("splitfusion");
  ASSERT_GE(kinds.size(), 2u);
  EXPECT_EQ(kinds[0], "rigid");
  EXPECT_EQ(kinds[1], "non_rigid");
}

TEST(Presets, OnlineFollowsCoarserThingsWithoutParts) {
  PipelineOptions options;
  ApplyPreset("online", &options);
  SyntheticRun run(SyntheticRun::Quick(), options);
  int tracked = 0;
  for (int i = 0; i < 4; ++i) {
    for (const SurfaceReport& surface : run.Next().surfaces) {
      EXPECT_EQ(surface.started_parts, 0);
      tracked += surface.id != 0 && !surface.rounds.empty() &&
                 surface.state == TrackState::kTracked;
    }
  }
  EXPECT_GE(tracked, 3);
  EXPECT_GT(options.object.tsdf.voxel_size,
            PipelineOptions().object.tsdf.voxel_size);
}

TEST(Presets, CoFusionHasRigidThings) {
  const std::vector<std::string> kinds = KindsOf("cofusion");
  ASSERT_GE(kinds.size(), 2u);
  EXPECT_EQ(std::count(kinds.begin(), kinds.end(), "rigid"),
            static_cast<int>(kinds.size()));
}

TEST(Presets, KinectFusionIsOneRigidSurface) {
  EXPECT_EQ(KindsOf("kinectfusion"), std::vector<std::string>{"rigid"});
}

TEST(Presets, DynamicFusionIsOneNonRigidSurface) {
  EXPECT_EQ(KindsOf("dynamicfusion"), std::vector<std::string>{"non_rigid"});
}

TEST(Presets, SceneThatNeedsManyNodesGetsAWiderSpacingAndSaysSo) {
  PipelineOptions options;
  ApplyPreset("dynamicfusion", &options);
  options.graph.max_nodes = 150;
  SyntheticRun run(SyntheticRun::Quick(), options);
  const FrameReport report = run.Next();
  ASSERT_EQ(report.surfaces.size(), 1u);
  EXPECT_LE(report.surfaces[0].nodes, 150);
  EXPECT_GT(report.surfaces[0].node_spacing, 2 * options.graph.far_spacing);
  EXPECT_EQ(report.surfaces[0].node_spacing,
            run.fusion().surfaces().at(0)->graph().node_spacing);
}

TEST(Presets, BackgroundOnlyModelsNothingElse) {
  EXPECT_EQ(KindsOf("background_only"), std::vector<std::string>{"rigid"});
}

}  // namespace
}  // namespace splitfusion
