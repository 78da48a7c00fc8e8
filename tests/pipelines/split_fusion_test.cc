// The whole method on synthetic frames in memory.

#include "splitfusion/pipelines/split_fusion.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>

#include "splitfusion/lib/energy/energy_term.h"
#include "splitfusion/lib/evaluation/trajectory_error.h"
#include "support/expect_input_error.h"
#include "support/rejected.h"
#include "support/synthetic_run.h"

namespace splitfusion {
namespace {

const SurfaceReport* Find(const FrameReport& report, int id) {
  for (const SurfaceReport& surface : report.surfaces) {
    if (surface.id == id) return &surface;
  }
  return nullptr;
}

std::string StateOf(const FrameReport& report, int id) {
  const SurfaceReport* surface = Find(report, id);
  return surface == nullptr       ? "none"
         : surface->event.empty() ? ToString(surface->state)
                                  : surface->event;
}

/// Id of the person's surface; -1 if there is none.
int PersonId(const SplitFusion& fusion) {
  for (const auto& [id, surface] : fusion.surfaces()) {
    if (surface->label() == "person") return id;
  }
  return -1;
}

double PoseError(const SyntheticRun& run, const SplitFusion& fusion) {
  const Trajectory truth = run.TrueTrajectory();
  const Rigid3d expected = truth.front().world_from_camera.inverse() *
                           truth.back().world_from_camera;
  return (fusion.trajectory().back().world_from_camera.translation() -
          expected.translation())
      .norm();
}

void ExpectSoundReport(const FrameReport& report) {
  const double whole = report.segment_seconds + report.split_seconds;
  EXPECT_GT(report.total_seconds, 0);
  for (const SurfaceReport& surface : report.surfaces) {
    // Not their sum: objects are tracked and fused at the same time.
    const double parts = surface.render_seconds + surface.associate_seconds +
                         surface.solve_seconds + surface.fuse_seconds +
                         surface.mesh_seconds;
    EXPECT_LE(whole + parts, 1.001 * report.total_seconds);
    EXPECT_NE(surface.state, TrackState::kTentative);
    EXPECT_EQ(ToString(surface.state) == "lost" && surface.reason.empty(),
              false);
    EXPECT_EQ(ToString(surface.state) == "tracked" && !surface.reason.empty(),
              false);
    EXPECT_FALSE(surface.label.empty());
    for (const TrackingRound& round : surface.rounds) {
      EXPECT_TRUE(round.stage == "rigid" || round.stage == "non_rigid");
      EXPECT_GE(round.anneal, 1);
      const AssociationCounts& c = round.association;
      EXPECT_EQ(c.accepted + Rejected(c), c.model_points);
      EXPECT_TRUE(std::isfinite(round.solver.final_cost));
      EXPECT_LE(round.solver.final_cost, round.solver.initial_cost);
    }
  }
}

TEST(SplitFusion, TracksCameraAndPersonAndMapsBoth) {
  SyntheticOptions scene;
  scene.width = 320, scene.height = 240;
  scene.frames = 10;
  SyntheticRun run(scene);
  const SplitFusion& fusion = run.fusion();
  int person_tracked = 0;
  for (int i = 0; i < scene.frames; ++i) {
    const FrameReport report = run.Next();
    ExpectSoundReport(report);
    EXPECT_EQ(report.frame, i);
    EXPECT_EQ(StateOf(report, 0), i == 0 ? "born" : "tracked");
    person_tracked += StateOf(report, PersonId(fusion)) == "tracked";
  }
  EXPECT_GE(person_tracked, scene.frames - 3);
  EXPECT_LT(CompareTrajectories(fusion.trajectory(), run.TrueTrajectory())
                .absolute.rmse,
            0.005);
  const int person = PersonId(fusion);
  ASSERT_GT(person, 0);
  const Surface& body = *fusion.surfaces().at(person);
  EXPECT_EQ(body.kind(), SurfaceKind::kNonRigid);
  EXPECT_GT(body.graph().size(), 100);
  EXPECT_GT(body.mesh().triangles.size(), 5000u);
  EXPECT_LT(run.MedianDepthError(person), 0.010);
  EXPECT_LT(run.MedianDepthError(0), 0.010);
  run.fusion().Finish();
  EXPECT_GT(fusion.surfaces().at(0)->mesh().vertices.size(), 20000u);
  for (const auto& [id, surface] : fusion.surfaces()) {
    EXPECT_EQ(surface->history().frame(0), surface->first_frame());
    for (const FrameMotions& motions : surface->history().All()) {
      ASSERT_EQ(motions.motions.size(), surface->graph().positions.size());
    }
  }
}

TEST(SplitFusion, AFrameWithoutDepthIsLostAndSurvived) {
  for (const float nothing : {0.f, std::numeric_limits<float>::quiet_NaN()}) {
    SyntheticRun run(SyntheticRun::Quick());
    for (int i = 0; i < 3; ++i) run.Next();
    const FrameReport lost =
        run.Next([&](Frame* frame, std::vector<InstanceMask>*) {
          frame->depth.setTo(nothing);
        });
    ExpectSoundReport(lost);
    EXPECT_EQ(StateOf(lost, 0), "lost");
    EXPECT_NE(Find(lost, 0)->reason.find("correspondences"), std::string::npos)
        << Find(lost, 0)->reason;
    EXPECT_NE(StateOf(lost, PersonId(run.fusion())), "tracked");
    EXPECT_TRUE(run.fusion()
                    .trajectory()
                    .back()
                    .world_from_camera.matrix()
                    .allFinite());
    const FrameReport found = run.Next();
    EXPECT_EQ(StateOf(found, 0), "tracked");
    EXPECT_LT(PoseError(run, run.fusion()), 0.02);
    EXPECT_EQ(run.fusion().trajectory().size(), 5u);
    const auto motions = run.fusion().surfaces().at(0)->history().Find(3);
    ASSERT_TRUE(motions.has_value());
    EXPECT_FALSE(motions->tracked);
  }
}

constexpr int kJump = 64;  // Pixels.

/// The person stands aside by kJump at once.
void JumpAside(Frame* frame, std::vector<InstanceMask>* detections) {
  const auto moved = [](const cv::Mat& image, const cv::Mat& mask) {
    const cv::Mat shift = (cv::Mat_<double>(2, 3) << 1, 0, kJump, 0, 1, 0);
    cv::Mat result = cv::Mat::zeros(image.size(), image.type());
    image.copyTo(result, mask);
    cv::warpAffine(result, result, shift, image.size(), cv::INTER_NEAREST);
    return result;
  };
  for (InstanceMask& detection : *detections) {
    if (detection.class_name != "person") continue;
    const cv::Mat depth = moved(frame->depth, detection.mask);
    const cv::Mat color = moved(frame->color, detection.mask);
    const cv::Mat mask = moved(detection.mask, detection.mask);
    frame->depth.setTo(0, detection.mask);
    depth.copyTo(frame->depth, mask);
    color.copyTo(frame->color, mask);
    detection.mask = mask;
  }
}

TEST(SplitFusion, APersonWhoJumpsIsFoundWhereHisPixelsAre) {
  SyntheticOptions scene = SyntheticRun::Quick();
  scene.width = 320, scene.height = 240;
  PipelineOptions options;
  options.split.assignment.place_sigma = 1;  // A jump is not improbable.
  SyntheticRun run(scene, options);
  for (int i = 0; i < 3; ++i) run.Next();
  const int person = PersonId(run.fusion());
  const auto center = [&] {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const DeformationGraph& graph = run.fusion().surfaces().at(person)->graph();
    for (int i = 0; i < graph.size(); ++i) {
      sum += graph.positions[i] + graph.motions[i].translation;
    }
    return Eigen::Vector3d(sum / graph.size());
  };
  const Eigen::Vector3d before = center();
  const FrameReport report = run.Next(JumpAside);
  EXPECT_EQ(StateOf(report, person), "tracked") << Find(report, person)->reason;
  const PinholeCamera& camera = run.fusion().camera();
  // He walks a little, too.
  EXPECT_NEAR(camera.Project(center()).x() - camera.Project(before).x(), kJump,
              4);
}

/// A board before all of a person but a strip of his left side.
void HideBehindBoard(Frame* frame, std::vector<InstanceMask>* detections) {
  for (InstanceMask& detection : *detections) {
    if (detection.class_name != "person") continue;
    cv::Rect box = cv::boundingRect(detection.mask);
    box.x += box.width / 5;
    const cv::Rect image(0, 0, frame->depth.cols, frame->depth.rows);
    const cv::Rect board = cv::Rect(box.x, 0, box.width, image.height) & image;
    frame->depth(board).setTo(0.7f);
    frame->color(board).setTo(cv::Scalar(40, 160, 160));
    detection.mask(board).setTo(0);
    InstanceMask occluder = detection;
    occluder.class_name = "dog";
    // Not zeros(), which would be written into the mask they share.
    occluder.mask = cv::Mat(image.size(), CV_8UC1, cv::Scalar(0));
    occluder.mask(board).setTo(255);
    detections->push_back(occluder);
    return;
  }
}

TEST(SplitFusion, AMostlyHiddenPersonIsCarriedOnAndComesBack) {
  SyntheticOptions scene = SyntheticRun::Quick();
  scene.width = 320, scene.height = 240;
  SyntheticRun run(scene);
  for (int i = 0; i < 6; ++i) run.Next();
  const int person = PersonId(run.fusion());
  const std::size_t vertices =
      run.fusion().surfaces().at(person)->mesh().vertices.size();
  for (int i = 0; i < 4; ++i) {
    const FrameReport report = run.Next(HideBehindBoard);
    ExpectSoundReport(report);
    EXPECT_EQ(StateOf(report, person), "occluded");
    EXPECT_NE(Find(report, person)->reason.find("in view"), std::string::npos);
    const Surface& surface = *run.fusion().surfaces().at(person);
    EXPECT_FALSE(surface.history().tracked(surface.history().size() - 1));
    EXPECT_EQ(surface.mesh().vertices.size(), vertices);
  }
  const FrameReport back = run.Next();
  EXPECT_EQ(StateOf(back, person), "tracked") << Find(back, person)->reason;
  run.Next();
  EXPECT_LT(run.MedianDepthError(person), 0.01);
  const std::size_t grown =
      run.fusion().surfaces().at(person)->mesh().vertices.size();
  EXPECT_LT(grown, 1.3 * vertices);
}

TEST(SplitFusion, IsFoundAgainOnlyIfItExplainsItsPixels) {
  SyntheticOptions scene = SyntheticRun::Quick();
  scene.width = 320, scene.height = 240;
  PipelineOptions options;
  options.min_coverage = 1;  // Not every live pixel has a model point.
  SyntheticRun run(scene, options);
  for (int i = 0; i < 6; ++i) run.Next();
  const int person = PersonId(run.fusion());
  EXPECT_EQ(StateOf(run.Next(HideBehindBoard), person), "occluded");
  const FrameReport back = run.Next();
  EXPECT_EQ(StateOf(back, person), "lost");
  EXPECT_NE(Find(back, person)->reason.find("model points for"),
            std::string::npos)
      << Find(back, person)->reason;
  // Points of where it was not believed to be are not followed.
  const FrameReport after = run.Next();
  EXPECT_EQ(StateOf(after, person), "lost");
  EXPECT_LE(Find(after, person)->track_points,
            Find(back, person)->track_points);
}

TEST(SplitFusion, FollowsPointsOfThePersonUnlessToldNotTo) {
  for (const int spacing : {8, 0}) {
    SyntheticOptions scene = SyntheticRun::Quick();
    scene.width = 320, scene.height = 240;
    PipelineOptions options;
    options.point_tracks.spacing = spacing;
    SyntheticRun run(scene, options);
    FrameReport report;
    for (int i = 0; i < 5; ++i) report = run.Next();
    const SurfaceReport& person = *Find(report, PersonId(run.fusion()));
    EXPECT_EQ(Find(report, 0)->track_points, 0);
    if (spacing == 0) {
      EXPECT_EQ(person.track_points, 0);
      continue;
    }
    // Most of one in every cell of what is seen of him.
    EXPECT_GT(person.track_points, 0.3 * person.pixels / (spacing * spacing));
    const std::vector<TermCost>& terms = person.rounds.back().solver.terms;
    EXPECT_TRUE(
        std::any_of(terms.begin(), terms.end(), [](const TermCost& term) {
          return term.term == "tracks" && term.residual_vectors > 0;
        }));
  }
}

TEST(SplitFusion, HiddenSurfacesComeBackAtAnyMinimum) {
  SyntheticOptions scene = SyntheticRun::Quick();
  scene.width = 320, scene.height = 240;
  PipelineOptions options;
  options.min_exposure = 1;
  SyntheticRun run(scene, options);
  for (int i = 0; i < 6; ++i) run.Next();
  const int person = PersonId(run.fusion());
  EXPECT_EQ(StateOf(run.Next(HideBehindBoard), person), "occluded");
  const FrameReport back = run.Next();
  EXPECT_EQ(StateOf(back, person), "tracked") << Find(back, person)->reason;
}

TEST(SplitFusion, BeginsWithTheFirstFrameThatHasDepth) {
  SyntheticRun run(SyntheticRun::Quick());
  const FrameReport blind = run.Next(
      [](Frame* frame, std::vector<InstanceMask>*) { frame->depth.setTo(0); });
  EXPECT_TRUE(blind.surfaces.empty());
  EXPECT_TRUE(run.fusion().surfaces().empty());
  EXPECT_EQ(StateOf(run.Next(), 0), "born");
  EXPECT_EQ(StateOf(run.Next(), 0), "tracked");
  EXPECT_EQ(run.fusion().trajectory().size(), 3u);
  run.fusion().Finish();
  EXPECT_FALSE(run.fusion().surfaces().at(0)->mesh().empty());
}

TEST(SplitFusion, EmptyMasksAndBlackImagesAreNoHarm) {
  SyntheticRun run(SyntheticRun::Quick());
  for (int i = 0; i < 4; ++i) {
    const FrameReport report =
        run.Next([&](Frame* frame, std::vector<InstanceMask>* masks) {
          if (i % 2 == 1) masks->clear();
          for (InstanceMask& mask : *masks) mask.mask.setTo(0);
          frame->color.setTo(0);
        });
    ExpectSoundReport(report);
    EXPECT_EQ(StateOf(report, 0), i == 0 ? "born" : "tracked");
  }
  EXPECT_EQ(run.fusion().surfaces().size(), 1u);
}

TEST(SplitFusion, WithoutSegmenterThereIsOneSurface) {
  const SyntheticScene scene(SyntheticRun::Quick());
  SplitFusion fusion(scene.camera(), PipelineOptions(), LabelTable(), nullptr);
  for (int i = 0; i < 2; ++i) fusion.ProcessFrame(scene.Render(i).frame);
  EXPECT_EQ(fusion.surfaces().size(), 1u);
  EXPECT_EQ(cv::countNonZero(fusion.labels()), 0);
}

TEST(SplitFusion, RunsAndThreadsGiveTheSameBytes) {
  const auto run = [](int threads) {
    const tbb::global_control control(
        tbb::global_control::max_allowed_parallelism, threads);
    auto result = std::make_unique<SyntheticRun>(SyntheticRun::Quick());
    for (int i = 0; i < 4; ++i) result->Next();
    result->fusion().Finish();
    return result;
  };
  const auto two = run(2);
  EXPECT_GT(two->fusion().surfaces().size(), 1u);
  EXPECT_TRUE(SameResults(two->fusion(), run(2)->fusion())) << "two runs";
  EXPECT_TRUE(SameResults(two->fusion(), run(1)->fusion())) << "one thread";
}

TEST(SplitFusion, RefusesFramesThatDoNotFit) {
  const SyntheticScene scene(SyntheticRun::Quick());
  SplitFusion fusion(scene.camera(), PipelineOptions(), LabelTable(), nullptr);
  Frame frame = scene.Render(0).frame;
  frame.depth = frame.depth(cv::Rect(0, 0, 80, 60));
  ExpectInputError([&] { fusion.ProcessFrame(frame); }, "expected 8UC3 of");
  frame.color = frame.color(cv::Rect(0, 0, 80, 60));
  ExpectInputError([&] { fusion.ProcessFrame(frame); }, "depth image is 80x60");
}

/// Counts how often it was asked.
class CountingTerm : public EnergyTerm {
 public:
  explicit CountingTerm(std::shared_ptr<int> count)
      : count_(std::move(count)) {}
  void AddResiduals(const EnergyInput&, ResidualSink*) const override {
    ++*count_;
  }

 private:
  std::shared_ptr<int> count_;
};

TEST(SplitFusion, TakesTermsOfOnesOwn) {
  const auto count = std::make_shared<int>(0);
  Registries registries;
  registries.terms.Register(
      "counting", [=] { return std::make_unique<CountingTerm>(count); });
  PipelineOptions options;
  options.terms += " counting(weight=2)";
  SyntheticRun run(SyntheticRun::Quick(), options, registries);
  run.Next();
  const FrameReport report = run.Next();
  EXPECT_GT(*count, 0);
  EXPECT_EQ(Find(report, 1)->rounds.at(0).solver.terms.back().term, "counting");
  ExpectInputError([&] { SyntheticRun(SyntheticRun::Quick(), options); },
                   "term = counting: expected point_to_plane");
}

}  // namespace
}  // namespace splitfusion
