#include "splitfusion/pipelines/surface_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/cost_functions/arap.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

/// The room's corner, tracked from rest to where the camera has moved.
struct CornerTracking {
  explicit CornerTracking(const Rigid3d& motion,
                          const TrackerOptions& options = {}) {
    const LiveView live = View(CornerDepth(motion));
    tracked = MakeTracker(options).Track(
        SamplesOf(View(CornerDepth(Rigid3d::Identity()))), {}, live, 0,
        Rigid3d::Identity(), &graph, &report);
  }
  bool tracked = false;
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
};

TEST(SurfaceTracker, FindsTheMotionOfTheCamera) {
  const Rigid3d motion = MakeMotion({0.02, -0.03, 0.01}, {0.03, -0.02, 0.02});
  const CornerTracking tracking(motion);
  EXPECT_TRUE(tracking.tracked);
  EXPECT_EQ(tracking.report.reason, "");
  const Rigid3d error = MeanRigidMotion(tracking.graph) * motion.inverse();
  EXPECT_LT(error.translation().norm(), 0.001);
  EXPECT_LT(RotationAngle(error.linear()), 0.001);
  EXPECT_LT(tracking.report.residual_rms, 0.001);
  int stride = 100;
  for (const TrackingRound& round : tracking.report.rounds) {
    EXPECT_EQ(round.stage, "rigid");
    EXPECT_LE(round.stride, stride) << "not from coarse to fine";
    stride = round.stride;
  }
}

TEST(SurfaceTracker, ALostFrameKeepsTheMotion) {
  TrackerOptions options;
  options.max_translation = 0.01;
  const Rigid3d motion = MakeMotion({0, 0, 0}, {0.03, 0, 0.02});
  const CornerTracking moved(motion, options);
  EXPECT_FALSE(moved.tracked);
  EXPECT_NE(moved.report.reason.find("m from its start"), std::string::npos)
      << moved.report.reason;
  EXPECT_EQ(moved.graph.motions[0].translation, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(moved.graph.motions[0].rotation, Eigen::Matrix3d::Identity());
  options = TrackerOptions();
  options.max_rotation = 0.01;
  const CornerTracking turned(MakeMotion({0, 0.03, 0}, {0, 0, 0}), options);
  EXPECT_FALSE(turned.tracked);
  EXPECT_NE(turned.report.reason.find("degrees from its start"),
            std::string::npos)
      << turned.report.reason;
}

TEST(SurfaceTracker, TooFewPointsAreNoTrack) {
  LiveView live = View(CornerDepth(Rigid3d::Identity()));
  const std::vector<ModelSample> samples = SamplesOf(live);
  live.labels.setTo(7);
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
  EXPECT_FALSE(MakeTracker().Track(samples, {}, live, 0, Rigid3d::Identity(),
                                   &graph, &report));
  EXPECT_EQ(report.reason.find("only 0 correspondences"), 0u) << report.reason;
  report = SurfaceReport();
  EXPECT_FALSE(MakeTracker().Track({}, {}, live, 0, Rigid3d::Identity(), &graph,
                                   &report));
  EXPECT_FALSE(report.reason.empty());
}

TEST(SurfaceTracker, AModelThatHardlyFitsIsNoTrack) {
  const std::vector<ModelSample> samples =
      SamplesOf(View(CornerDepth(Rigid3d::Identity())));
  cv::Mat_<float> depth = CornerDepth(Rigid3d::Identity());
  for (int u = 48; u < depth.cols; ++u) {
    // Waves of 1 m: nothing to be fitted.
    depth.col(u) *= 1.4f + 0.3f * std::sin(0.05f * u);
  }
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
  EXPECT_FALSE(MakeTracker().Track(samples, {}, View(depth), 0,
                                   Rigid3d::Identity(), &graph, &report));
  EXPECT_NE(report.reason.find("model points fit the depth"), std::string::npos)
      << report.reason;
}

TEST(SurfaceTracker, AnObjectThatIsMostlyElsewhereIsNoTrack) {
  const auto state = [](int id, double part) {
    BendingSheet sheet;
    sheet.live.labels.setTo(9);
    sheet.live.labels
        .colRange(0, static_cast<int>(part * sheet.live.labels.cols))
        .setTo(id);
    SurfaceReport report;
    const bool tracked = MakeTracker().Track(
        sheet.samples, {}, sheet.live, static_cast<std::uint16_t>(id),
        Rigid3d::Identity(), &sheet.graph, &report);
    return (tracked ? "tracked: " : "lost: ") + report.reason;
  };
  EXPECT_EQ(state(1, 0.7), "tracked: ");
  EXPECT_NE(state(1, 0.4).find("model points in view lie on it"),
            std::string::npos)
      << state(1, 0.4);
  // Before the background undetected things may stand.
  EXPECT_EQ(state(0, 0.4), "tracked: ");
}

TEST(SurfaceTracker, StartsFromThePredictionIfThatFitsBetter) {
  // 25 cm are beyond the gates; the prediction is 1 cm off.
  const Rigid3d motion = MakeMotion({0, 0, 0}, {0, 0, 0.25});
  const LiveView live = View(CornerDepth(motion));
  DeformationGraph graph = MakeRigidGraph(MakeMotion({0, 0, 0}, {0, 0, 0.24}));
  SurfaceReport report;
  EXPECT_TRUE(MakeTracker().Track(
      SamplesOf(View(CornerDepth(Rigid3d::Identity()))), {}, live, 0,
      MakeMotion({0, 0, 0}, {0, 0, -0.24}), &graph, &report))
      << report.reason;
  EXPECT_LT(
      (MeanRigidMotion(graph).translation() - motion.translation()).norm(),
      0.002);
}

TEST(SurfaceTracker, DoesNotFollowAPredictionThatFitsWorse) {
  const LiveView live = View(CornerDepth(Rigid3d::Identity()));
  DeformationGraph graph =
      MakeRigidGraph(MakeMotion({0, 0, 0}, {0.05, 0, 0.25}));
  SurfaceReport report;
  EXPECT_TRUE(MakeTracker().Track(SamplesOf(live), {}, live, 0,
                                  MakeMotion({0, 0, 0}, {-0.05, 0, -0.25}),
                                  &graph, &report))
      << report.reason;
  EXPECT_LT(MeanRigidMotion(graph).translation().norm(), 0.001);
}

TEST(SurfaceTracker, PointsThatWereFollowedHoldASurfaceAlongItself) {
  const LiveView live =
      View(PlaneDepth(Camera(), -Eigen::Vector3d::UnitZ(), -1.0));
  const std::vector<ModelSample> samples = SamplesOf(live);
  std::vector<TrackedPoint> points;
  for (std::size_t i = 0; i < samples.size(); i += 50) {
    points.push_back(
        {samples[i], samples[i].point + Eigen::Vector3f(0.02f, -0.01f, 0), 1});
  }
  const auto moved = [&](const std::string& terms) -> Eigen::Vector3d {
    DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
    SurfaceReport report;
    EXPECT_TRUE(MakeTracker({}, terms).Track(
        samples, points, live, 0, Rigid3d::Identity(), &graph, &report))
        << report.reason;
    return MeanRigidMotion(graph).translation();
  };
  EXPECT_LT(moved("").norm(), 1e-6);
  EXPECT_LT((moved("tracks") - Eigen::Vector3d(0.02, -0.01, 0)).norm(), 1e-4);
}

TEST(SurfaceTracker, BendsANonRigidSurfaceOntoTheDepth) {
  BendingSheet sheet;
  SurfaceReport report;
  ASSERT_TRUE(MakeTracker().Track(sheet.samples, {}, sheet.live, 0,
                                  Rigid3d::Identity(), &sheet.graph, &report))
      << report.reason;
  const WarpField warp(sheet.graph);
  double error = 0, before = 0;
  for (const ModelSample& s : sheet.samples) {
    const Eigen::Vector3f truth =
        BendingSheet::Bent(s.point.cast<double>()).cast<float>();
    error += (warp.WarpPoint(s.skinning, s.point) - truth).norm();
    before += (s.point - truth).norm();
  }
  EXPECT_LT(error / sheet.samples.size(), 0.004);
  EXPECT_GT(before / sheet.samples.size(), 0.008);
  double factor = 1e9;
  bool non_rigid = false;
  for (const TrackingRound& round : report.rounds) {
    if (round.stage == "rigid") continue;
    non_rigid = true;
    EXPECT_LE(round.anneal, factor) << "annealing must soften";
    factor = round.anneal;
  }
  EXPECT_TRUE(non_rigid);
  EXPECT_LT(factor, 2);
}

/// By how much the tip of an arm, 4 cm wide, is off its place in the mean,
/// metres, after it was swung sideways by 9 cm at the tip within one frame.
double ErrorOfSwungArm(const std::string& terms, SurfaceReport* report) {
  constexpr double kSwing = 0.36;  // Radians about the shoulder, x = 0.1.
  const auto sheet = [](double swing) {
    const auto place = [swing](double x, double y) -> Eigen::Vector3d {
      const double along = std::max(0.0, x - 0.1);
      const double angle = along > 0 ? swing : 0;
      return {x - along + std::cos(angle) * along - std::sin(angle) * y,
              std::sin(angle) * along + std::cos(angle) * y,
              1 + 0.01 * std::cos(60 * y)};
    };
    TriangleMesh mesh = SheetMesh(0.35, 0.04, 0.005, place);
    AppendMesh(SheetMesh(0.3, 0.4, 0.01,
                         [](double x, double y) -> Eigen::Vector3d {
                           return {
                               x - 0.2, y - 0.2,
                               1 + 0.03 * std::sin(14 * x) * std::cos(16 * y)};
                         }),
               &mesh);
    return mesh;
  };
  const TriangleMesh rest = sheet(0), swung = sheet(kSwing);
  DeformationGraph graph = CoverWithNodes(rest, 0.03);
  const SkinningIndex index(graph, 6);
  const auto view = [](const TriangleMesh& mesh) {
    cv::Mat_<float> depth = MeshDepth(Camera(), mesh);
    const cv::Mat_<uchar> seen = depth > 0;
    depth.setTo(2, depth == 0);  // A wall behind it.
    LiveView live = View(depth);
    live.labels.setTo(1, seen);
    return live;
  };
  std::vector<ModelSample> samples = SamplesOf(view(rest), 1);
  for (ModelSample& s : samples) s.skinning = index.Skin(s.point);
  EXPECT_TRUE(MakeTracker(TrackerOptions(), terms)
                  .Track(samples, {}, view(swung), 1, Rigid3d::Identity(),
                         &graph, report))
      << report->reason;
  const WarpField warp(graph);
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < rest.vertices.size(); ++i) {
    if (rest.vertices[i].x() < 0.3) continue;
    sum += (warp.WarpPoint(index.Skin(rest.vertices[i]), rest.vertices[i]) -
            swung.vertices[i])
               .norm();
    ++count;
  }
  return sum / count;
}

TEST(SurfaceTracker, FindsAnArmThatMovedFartherThanItsWidth) {
  SurfaceReport without, with;
  const std::string seen = "live_to_model(weight=1,loss=huber,scale=0.013)";
  const double beside = ErrorOfSwungArm("", &without);
  const double found = ErrorOfSwungArm(seen, &with);
  EXPECT_GT(beside, 0.05);
  EXPECT_LT(found, 0.5 * beside);
  // There are pairs in the first non-rigid stage only, fewer where they pull.
  const auto pairs = [](const SurfaceReport& report) {
    int sum = 0;
    for (const TrackingRound& round : report.rounds) {
      sum += round.lost_pairs;
      if (round.stage == "rigid") {
        EXPECT_EQ(round.lost_pairs, 0);
      }
    }
    EXPECT_EQ(report.rounds.back().lost_pairs, 0);
    return sum;
  };
  EXPECT_GT(pairs(with), 25);
  EXPECT_GT(pairs(without), 1.5 * pairs(with));
}

TEST(TrackerOptions, RefuseValuesOutOfRange) {
  const auto refused = [](auto set, const std::string& message) {
    TrackerOptions options;
    set(&options);
    ExpectInputError([&] { MakeTracker(options); }, message);
  };
  refused([](TrackerOptions* o) { o->rigid_distance = -1; },
          "rigid_distance = -1: expected metres > 0");
  refused([](TrackerOptions* o) { o->non_rigid_angle = 200; },
          "non_rigid_angle = 200: expected 0..180 degrees, not 0");
  refused([](TrackerOptions* o) { o->grazing_angle = 100; },
          "grazing_angle = 100");
  refused([](TrackerOptions* o) { o->prior_anneal = 0.5; },
          "prior_anneal = 0.5: expected >= 1");
  refused([](TrackerOptions* o) { o->min_correspondences = 5; },
          "min_correspondences = 5: expected pairs >= 6");
  refused([](TrackerOptions* o) { o->min_accepted = 2; },
          "min_accepted = 2: expected 0..1");
  refused([](TrackerOptions* o) { o->min_fit = 2; }, "min_fit = 2: expected");
  refused([](TrackerOptions* o) { o->max_translation = 0; },
          "max_translation = 0: expected metres > 0");
  refused([](TrackerOptions* o) { o->max_rotation = 0; },
          "max_rotation = 0: expected 0..180 degrees, not 0");
}

}  // namespace
}  // namespace splitfusion
