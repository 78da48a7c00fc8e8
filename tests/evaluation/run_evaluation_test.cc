#include "splitfusion/lib/evaluation/run_evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <utility>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/evaluation/evaluation_json.h"
#include "splitfusion/lib/evaluation/evaluation_table.h"
#include "support/bent_plate.h"
#include "support/motion_frames.h"
#include "support/repository.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

/// Renumbers the nodes of a surface from left to right.
void SortByX(RecordedSurface* surface) {
  DeformationGraph& graph = surface->graph;
  std::vector<int> order(graph.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return graph.positions[a].x() < graph.positions[b].x();
  });
  std::vector<int> number(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    number[order[i]] = static_cast<int>(i);
  }
  const DeformationGraph before = graph;
  for (std::size_t i = 0; i < order.size(); ++i) {
    graph.positions[i] = before.positions[order[i]];
    graph.neighbors[i] = before.neighbors[order[i]];
    for (int& j : graph.neighbors[i]) j = number[j];
  }
  EditFrames(
      [&](FrameMotions& frame) {
        const std::vector<NodeMotion> motions = frame.motions;
        for (std::size_t i = 0; i < order.size(); ++i) {
          frame.motions[i] = motions[order[i]];
        }
      },
      &surface->motions);
}

/// A run of the plate and its ground truth, as files.
class RunEvaluationTest : public ::testing::Test {
 protected:
  RunEvaluationTest() {
    options_.tracks.references = {0};
    options_.tracks.frames = 10;
    options_.surface.samples = 5000;
    std::filesystem::create_directories(folder_ / "run");
    plate_.WriteRun(folder_ / "run");
    plate_.WriteGroundTruth(folder_ / "sequence/gt");
    plate_.WriteSequence(folder_ / "sequence", folder_ / "run");
  }

  RunEvaluation Evaluate() const {
    return Evaluate(ReadGroundTruth(folder_ / "sequence"));
  }

  RunEvaluation Evaluate(const std::optional<GroundTruth>& truth) const {
    RecordedRun run = ReadRun(folder_ / "run");
    const auto surfaces = AnimateSurfaces(std::move(run.surfaces));
    return EvaluateRun(run, surfaces, truth, options_);
  }

  void Remove(const std::string& name) const {
    std::filesystem::remove_all(folder_ / name);
  }

  TemporaryFolder folder_;
  BentPlate plate_;
  EvaluationOptions options_;
};

TEST_F(RunEvaluationTest, PerfectRunHasNoErrors) {
  const RunEvaluation evaluation = Evaluate();
  ASSERT_TRUE(evaluation.trajectory);
  EXPECT_EQ(evaluation.trajectory->matched, 12);
  EXPECT_LT(evaluation.trajectory->absolute.max, 1e-6);
  EXPECT_TRUE(evaluation.trajectory->truth_from_estimate_by_poses.isApprox(
      BentPlate::TrueWorldFromWorld(), 1e-4));
  ASSERT_TRUE(evaluation.background);
  EXPECT_LT(evaluation.background->accuracy.statistics.max, 1e-4);
  EXPECT_LT(evaluation.background->completeness.statistics.max, 1e-4);
  EXPECT_DOUBLE_EQ(evaluation.background->f_score[0], 1);
  EXPECT_TRUE(evaluation.skipped.empty());
}

TEST_F(RunEvaluationTest, WarpedPlateLiesOnItsTruth) {
  const RunEvaluation evaluation = Evaluate();
  ASSERT_EQ(evaluation.instances.size(), 1u);
  const InstanceError& plate = evaluation.instances[0];
  EXPECT_EQ(plate.name, "plate1");
  EXPECT_EQ(plate.surface_id, 1);
  EXPECT_EQ(plate.surface_label, "thin_plate");
  ASSERT_EQ(plate.frames.size(), 2u);
  EXPECT_EQ(plate.frames[1].frame, 6);
  for (const InstanceFrameError& frame : plate.frames) {
    EXPECT_TRUE(frame.matched);
    EXPECT_LT(frame.surface.accuracy.statistics.max, 0.001);
    EXPECT_LT(frame.surface.completeness.statistics.max, 0.001);
    EXPECT_GT(frame.view.pixels, 1000);
    EXPECT_LT(frame.view.uncovered, 30);  // At the border of the plate.
    EXPECT_LT(frame.view.distances.statistics.p90, 0.001);
  }
}

TEST_F(RunEvaluationTest, AModelIsThatOfItsFrame) {
  // The right half of the plate is born after frame 0 and, before that, off by
  // 10 cm: of no account in frame 0, and all right in frame 6.
  RecordedRun run = ReadRun(folder_ / "run");
  RecordedSurface& plate = run.surfaces[1];
  SortByX(&plate);
  DeformationGraph& graph = plate.graph;
  for (int i = 0; i < graph.size(); ++i) {
    const bool left = graph.positions[i].x() < 0;
    graph.first_seen.push_back(left ? 0 : 1);
    if (left) continue;
    EditFrame(
        0, [i](FrameMotions& f) { f.motions[i].translation.z() += 0.1; },
        &plate.motions);
  }
  const auto frames = [&] {
    return EvaluateRun(run, AnimateSurfaces(run.surfaces),
                       ReadGroundTruth(folder_ / "sequence"), options_)
        .instances[0]
        .frames;
  };
  const std::vector<InstanceFrameError> seen = frames();
  // But for a strip as wide as the node spacing, an eighth of the half, and
  // what the nodes on either side of the border carry together.
  EXPECT_LT(seen[0].surface.accuracy.statistics.median, 0.001);
  EXPECT_GT(seen[0].surface.accuracy.within[0], 0.7);
  EXPECT_NEAR(seen[0].surface.completeness.within[0], 0.5, 0.1);
  // At the other half's pixels is the wall, half a metre behind.
  EXPECT_NEAR(seen[0].view.distances.statistics.mean, 0.15, 0.03);
  EXPECT_LT(seen[1].surface.completeness.statistics.max, 0.001);
  graph.first_seen.clear();
  const std::vector<InstanceFrameError> whole = frames();
  EXPECT_NEAR(whole[0].surface.accuracy.statistics.mean, 0.05, 0.01);
  EXPECT_NEAR(whole[0].surface.completeness.within[0], 0.5, 0.1);
  EXPECT_LT(whole[0].view.distances.statistics.mean, 0.1);
}

TEST_F(RunEvaluationTest, AModelOfWhichNothingWasSeenYetIsEmpty) {
  RecordedRun run = ReadRun(folder_ / "run");
  DeformationGraph& graph = run.surfaces[1].graph;
  graph.first_seen.assign(graph.size(), 3);
  const RunEvaluation evaluation =
      EvaluateRun(run, AnimateSurfaces(run.surfaces),
                  ReadGroundTruth(folder_ / "sequence"), options_);
  const std::vector<InstanceFrameError>& frames =
      evaluation.instances[0].frames;
  EXPECT_EQ(frames[0].surface.accuracy.statistics.count, 0u);
  EXPECT_FLOAT_EQ(frames[0].surface.completeness.statistics.mean, 0.3);
  EXPECT_EQ(frames[0].surface.f_score[2], 0);
  EXPECT_LT(frames[1].surface.accuracy.statistics.max, 0.001);
}

TEST_F(RunEvaluationTest, ViewErrorSeesWhatIsThereInsteadOfTheInstance) {
  Remove("run/surfaces/001_thin_plate");
  const RunEvaluation evaluation = Evaluate();
  ASSERT_EQ(evaluation.instances.size(), 1u);
  const InstanceError& plate = evaluation.instances[0];
  EXPECT_EQ(plate.surface_id, -1);
  EXPECT_FALSE(plate.frames[0].matched);
  // The wall is half a metre behind: clipped to 0.3 m.
  EXPECT_FLOAT_EQ(plate.frames[0].view.distances.statistics.median, 0.3);
  EXPECT_THAT(evaluation.skipped, Contains(HasSubstr("instance 1")));
}

TEST_F(RunEvaluationTest, TracksFollowTheBendingPlate) {
  const RunEvaluation evaluation = Evaluate();
  ASSERT_TRUE(evaluation.tracks);
  const TrackErrors& errors = evaluation.tracks->errors;
  EXPECT_EQ(errors.points, 25);
  EXPECT_EQ(errors.frames, 10);
  EXPECT_EQ(evaluation.tracks->attached, 25);
  EXPECT_EQ(errors.all.visible.count, 250);
  EXPECT_LT(errors.all.visible.max, 0.001);
  // A plate that bends is neither still nor rigid.
  EXPECT_GT(errors.all.still_world.mean, 0.01);
  EXPECT_GT(errors.all.rigid.mean, 0.003);
  EXPECT_LT(errors.all.rigid.mean, errors.all.still_world.mean);
  EXPECT_EQ(errors.instances.at(1).visible.count, 250);
}

TEST_F(RunEvaluationTest, WhoIsNotShownIsMissingAndNotAbsent) {
  options_.presence.plain_view_pixels = 1000;
  RecordedRun run = ReadRun(folder_ / "run");
  EditFrames(
      [](FrameMotions& frame) {
        if (frame.frame < 4) return;
        frame.tracked = false;  // Left out, if it were not in plain view.
        for (NodeMotion& motion : frame.motions) motion.translation.x() += 0.6;
      },
      &run.surfaces[1].motions);
  const RunEvaluation evaluation =
      EvaluateRun(run, AnimateSurfaces(run.surfaces),
                  ReadGroundTruth(folder_ / "sequence"), options_);
  const InstanceError& plate = evaluation.instances[0];
  ASSERT_TRUE(plate.presence);
  EXPECT_EQ(plate.presence->surface_id, 1);
  EXPECT_EQ(plate.presence->in_view, (std::vector<int>{0, 6}));
  EXPECT_EQ(plate.presence->missing, std::vector<int>{6});
  const InstanceFrameError& lost = plate.frames[1];
  EXPECT_TRUE(lost.missing && lost.matched);
  EXPECT_EQ(lost.surface.f_score[2], 0);
  EXPECT_EQ(lost.surface.accuracy.statistics.mean, 0.3);
  EXPECT_EQ(lost.view.uncovered, lost.view.pixels);
  const auto json = ToJson(evaluation);
  const auto& instance = json.at("instances")[0];
  EXPECT_EQ(instance.at("presence").at("share"), 0.5);
  EXPECT_EQ(instance.at("surface_frames"), 2);
  EXPECT_EQ(instance.at("surface_frames_missing"), 1);
  EXPECT_NEAR(instance.at("surface").at("f_score").at("0.02"), 0.5, 0.01);
  EXPECT_NEAR(instance.at("surface").at("f_score_seen"), 0.5, 0.01);
  EXPECT_NEAR(json.at("headline").at("surface_error_m"), 0.15, 0.001);
  EXPECT_NEAR(json.at("headline").at("missing"), 0.5, 0.05);
  EXPECT_LT(instance.at("surface_where_shown")
                .at("accuracy")
                .at("mean")
                .get<double>(),
            0.001);
}

TEST_F(RunEvaluationTest, APerfectModelHasAllThatWasSeen) {
  options_.presence.plain_view_pixels = 1000;
  const InstanceError plate = Evaluate().instances[0];
  ASSERT_TRUE(plate.seen);
  EXPECT_EQ(plate.seen->surface_id, 1);
  EXPECT_EQ(plate.seen->frames.size(), 2u);
  EXPECT_GT(plate.seen->Mean().f_score, 0.99);
  EXPECT_TRUE(plate.presence->missing.empty());
  ASSERT_TRUE(plate.shape);
  EXPECT_EQ(plate.shape->frames, 12);
  EXPECT_EQ(plate.shape->stretched.worst, 0);
  EXPECT_LT(plate.shape->stray->worst, 0.01);
}

TEST_F(RunEvaluationTest, AModelBehindTheLiveDepthIsStray) {
  RecordedRun run = ReadRun(folder_ / "run");
  EditFrame(
      5,
      [](FrameMotions& frame) {
        for (NodeMotion& motion : frame.motions) motion.translation.z() += 0.05;
      },
      &run.surfaces[1].motions);
  const auto shapes =
      EvaluateRun(run, AnimateSurfaces(run.surfaces), std::nullopt, options_)
          .shapes;
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_GT(shapes[0].stray->worst, 0.9);
  EXPECT_EQ(shapes[0].stray->worst_frame, 5);
  EXPECT_NEAR(shapes[0].stray->mean, shapes[0].stray->worst / 12, 0.01);
}

TEST_F(RunEvaluationTest, AShortRunIsFollowedThroughHalfOfItsFrames) {
  options_.tracks.references.clear();
  options_.tracks.frames = 30;
  const RunEvaluation evaluation = Evaluate();
  ASSERT_TRUE(evaluation.tracks);
  EXPECT_EQ(evaluation.tracks->errors.reference_frame, 0);
  EXPECT_EQ(evaluation.tracks->errors.frames, 5);  // Of 0 to 11.
}

TEST_F(RunEvaluationTest, SeveralReferenceFramesGiveTheirMean) {
  options_.tracks.references = {0, 4, 50};
  const RunEvaluation evaluation = Evaluate();
  EXPECT_THAT(evaluation.skipped,
              Contains("track error: frame 50 is not in the run"));
  const auto tracks = ToJson(evaluation).at("tracks");
  EXPECT_TRUE(tracks.at("reference_frame").is_null());
  const auto& each = tracks.at("by_reference");
  ASSERT_EQ(each.size(), 2u);
  EXPECT_EQ(each[1].at("reference_frame"), 4);
  EXPECT_EQ(each[1].at("frames"), 7);
  EXPECT_NEAR(tracks.at("visible").at("mean"),
              (each[0].at("visible").at("mean").get<double>() +
               each[1].at("visible").at("mean").get<double>()) /
                  2,
              1e-12);
}

TEST_F(RunEvaluationTest, PicksTheFirstOfEquallyGoodTrackFrames) {
  options_.tracks.references.clear();
  EXPECT_EQ(Evaluate().tracks->errors.reference_frame, 0);
}

TEST_F(RunEvaluationTest, SaysWhatIsSkipped) {
  for (const auto* name : {"static_mesh.ply", "mesh", "tracks.bin"}) {
    Remove(std::string("sequence/gt/") + name);
  }
  const RunEvaluation evaluation = Evaluate();
  EXPECT_FALSE(evaluation.background);
  EXPECT_FALSE(evaluation.tracks);
  EXPECT_THAT(evaluation.skipped,
              testing::ElementsAre(HasSubstr("no static_mesh.ply"),
                                   HasSubstr("no mesh/instK_T.ply"),
                                   HasSubstr("no tracks.bin")));
  EXPECT_THAT(FormatTable(evaluation), HasSubstr("skipped: track error"));
}

TEST_F(RunEvaluationTest, TracksOfAFrameBeyondTheTruthAreSkipped) {
  options_.tracks.references = {50};
  EXPECT_THAT(Evaluate().skipped,
              Contains("track error: frame 50 is not in the run"));
}

TEST_F(RunEvaluationTest, WithoutTruthTheDepthAgreementIsLeft) {
  const RunEvaluation evaluation = Evaluate(std::nullopt);
  EXPECT_EQ(evaluation.depth.size(), 2u);
  EXPECT_THAT(evaluation.skipped,
              testing::ElementsAre(HasSubstr("no ground truth")));
  const auto json = ToJson(evaluation);
  EXPECT_TRUE(json.at("ground_truth").is_null());
  EXPECT_TRUE(json.at("ate").is_null());
  EXPECT_THAT(FormatTable(evaluation),
              testing::AllOf(HasSubstr("model - live depth"),
                             testing::StartsWith("model area")));
  EXPECT_EQ(json.at("headline").at("stretched"), 0);
  EXPECT_TRUE(json.at("headline").at("f_score_seen").is_null());
}

TEST_F(RunEvaluationTest, WithoutTheSequenceTheTruthIsLeft) {
  const GroundTruth truth = ReadGroundTruth(folder_ / "sequence");
  for (const std::string name : {"run/masks", "sequence/depth"}) {
    Remove(name);
    const RunEvaluation evaluation = Evaluate(truth);
    EXPECT_TRUE(evaluation.depth.empty());
    EXPECT_TRUE(evaluation.background);
    EXPECT_THAT(
        evaluation.skipped,
        Contains(testing::AllOf(testing::StartsWith("depth agreement: "),
                                HasSubstr(name + "/stem0.png"))));
  }
  options_.depth_every = 0;
  EXPECT_THAT(Evaluate(truth).skipped,
              Contains("depth agreement: not asked for"));
}

TEST_F(RunEvaluationTest, IsRepeatable) {
  EXPECT_EQ(ToJson(Evaluate()), ToJson(Evaluate()));
}

/// All keys of all objects in a value.
void CollectKeys(const nlohmann::ordered_json& value,
                 std::set<std::string>* keys) {
  for (const auto& [key, item] : value.items()) {
    if (value.is_object()) keys->insert(key);
    if (item.is_structured()) CollectKeys(item, keys);
  }
}

TEST_F(RunEvaluationTest, EveryJsonKeyIsDocumented) {
  std::ifstream page(RepositoryRoot() / "docs/evaluation.md");
  const std::string text(std::istreambuf_iterator<char>(page), {});
  const auto json = ToJson(Evaluate());
  EXPECT_LT(json.at("ate").at("rmse").get<double>(), 1e-6);
  std::set<std::string> keys;
  CollectKeys(json, &keys);
  for (const std::string& key : keys) {
    EXPECT_THAT(text, HasSubstr("`" + key + "`"));
  }
}

TEST(EvaluationOptions, RejectsNonsense) {
  EvaluationOptions options;
  options.depth_every = -1;
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.tracks.frames = 0;
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.tracks.references = {-2};
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.presence_every = -1;
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.surface.samples = 0;
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.trajectory.relative_frames = {1, -1};
  EXPECT_THROW(options.Check(), InputError);
}

TEST_F(RunEvaluationTest, TruthInGtGoesBeforeATrajectoryBesideTheImages) {
  std::filesystem::copy_file(folder_ / "sequence/gt/groundtruth.txt",
                             folder_ / "sequence/groundtruth.txt");
  const GroundTruth truth = ReadGroundTruth(folder_ / "sequence");
  EXPECT_EQ(truth.folder, folder_ / "sequence/gt");
  EXPECT_FALSE(truth.static_mesh.empty());
  EXPECT_FALSE(truth.tracks.empty());
  std::filesystem::remove(folder_ / "sequence/gt/groundtruth.txt");
  EXPECT_TRUE(ReadGroundTruth(folder_ / "sequence").static_mesh.empty());
}

TEST(ReadGroundTruth, NeedsATrajectory) {
  const TemporaryFolder folder;
  try {
    ReadGroundTruth(folder / "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected a folder with groundtruth"));
  }
}

}  // namespace
}  // namespace splitfusion
