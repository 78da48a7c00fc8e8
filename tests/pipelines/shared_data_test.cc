// The method on the first frames of real and rendered sequences.

#include "support/shared_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/evaluation/trajectory_error.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

constexpr int kSharedFrames = 12;

/// Result of processing the first frames of a sequence.
struct Outcome {
  std::unique_ptr<SplitFusion> fusion;
  int lost = 0;                ///< Surfaces lost, all frames together.
  std::map<int, int> tracked;  ///< Frames, by surface.
  std::map<int, double> fit;   ///< Median |depth difference|, metres.
};

/// Median distance of the rendered model to the live depth, by surface.
std::map<int, double> FitToDepth(const SplitFusion& fusion,
                                 const cv::Mat_<float>& depth) {
  const SceneRendering model = RenderScene(fusion.surfaces(), fusion.camera(),
                                           fusion.options().ray_cast);
  std::map<int, std::vector<float>> errors;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const float z = model.map.points(v, u)[2];
      const int id = model.labels(v, u);
      if (z > 0 && depth(v, u) > 0 && fusion.labels()(v, u) == id) {
        errors[id].push_back(std::abs(z - depth(v, u)));
      }
    }
  }
  std::map<int, double> medians;
  for (auto& [id, list] : errors) {
    const auto middle = list.begin() + list.size() / 2;
    std::nth_element(list.begin(), middle, list.end());
    medians[id] = *middle;
  }
  return medians;
}

Outcome Process(const std::string& sequence) {
  ReaderOptions options;
  options.max_frames = kSharedFrames;
  ImageFolderReader reader(sequence, options);
  Outcome outcome;
  outcome.fusion = std::make_unique<SplitFusion>(
      reader.camera(), PipelineOptions(), LabelTable(),
      std::make_shared<MaskFolderSegmenter>(FindMaskFolder(sequence)));
  cv::Mat last_depth;
  while (const std::optional<Frame> frame = reader.Next()) {
    const FrameReport report = outcome.fusion->ProcessFrame(*frame);
    for (const SurfaceReport& surface : report.surfaces) {
      outcome.lost += ToString(surface.state) == "lost";
      outcome.tracked[surface.id] +=
          surface.event.empty() && surface.state == TrackState::kTracked;
    }
    last_depth = frame->depth;
  }
  outcome.fit = FitToDepth(*outcome.fusion, last_depth);
  return outcome;
}

TEST(SharedData, WalkingXyzIsTracked) {
  const std::string sequence = SharedData("walking_xyz");
  SKIP_WITHOUT_SHARED_DATA(sequence, "walking_xyz");
  const Outcome outcome = Process(sequence);
  EXPECT_EQ(outcome.fusion->trajectory().size(),
            static_cast<std::size_t>(kSharedFrames));
  EXPECT_EQ(outcome.tracked.at(0), kSharedFrames - 1);
  EXPECT_LE(outcome.lost, 1);
  EXPECT_LT(
      CompareTrajectories(outcome.fusion->trajectory(),
                          ReadTumTrajectory(sequence + "/gt/groundtruth.txt"))
          .absolute.rmse,
      0.010);
  EXPECT_LT(outcome.fit.at(0), 0.015);
}

TEST(SharedData, SnoopyIsTrackedByACameraThatStands) {
  const std::string sequence = SharedData("snoopy");
  SKIP_WITHOUT_SHARED_DATA(sequence, "snoopy");
  const Outcome outcome = Process(sequence);
  ASSERT_EQ(outcome.fusion->surfaces().size(), 2u);
  const Surface& toy = *outcome.fusion->surfaces().rbegin()->second;
  EXPECT_EQ(toy.kind(), SurfaceKind::kNonRigid);
  EXPECT_GT(toy.graph().size(), 30);
  EXPECT_GE(outcome.tracked.at(toy.id()), kSharedFrames - 3);
  EXPECT_EQ(outcome.tracked.at(0), kSharedFrames - 1);
  for (const TimedPose& pose : outcome.fusion->trajectory()) {
    EXPECT_LT(pose.world_from_camera.translation().norm(), 0.010);
  }
  EXPECT_LT(outcome.fit.at(toy.id()), 0.006);
  EXPECT_LT(outcome.fit.at(0), 0.010);
}

}  // namespace
}  // namespace splitfusion
