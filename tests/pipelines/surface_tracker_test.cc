#include "splitfusion/pipelines/surface_tracker.h"

#include <gtest/gtest.h>

#include <cmath>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "support/expect_input_error.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// 320x240 pixels.
PinholeCamera Camera() {
  PinholeCamera camera = SmallCamera();
  camera.width *= 2, camera.height *= 2;
  camera.fx *= 2, camera.fy *= 2, camera.cx *= 2, camera.cy *= 2;
  return camera;
}

LiveView View(const cv::Mat_<float>& depth) {
  return MakeLiveView(Camera(), depth, PlainColor(Camera(), {90, 90, 90}));
}

/// Depth of three slanted planes that meet like those of a room's corner.
cv::Mat_<float> CornerDepth(const Rigid3d& camera_from_world) {
  const std::vector<std::pair<Eigen::Vector3d, double>> planes = {
      {Eigen::Vector3d(0.2, 0, 1).normalized(), 1.5},
      {{-0.6, 0, 0.8}, 1.15},
      {{0, 0.6, 0.8}, 1.1}};
  cv::Mat_<float> nearest(Camera().height, Camera().width, 9.f);
  for (const auto& [n, d] : planes) {
    const Eigen::Vector3d moved = camera_from_world.linear() * n;
    cv::Mat_<float> depth = PlaneDepth(
        Camera(), moved, d + moved.dot(camera_from_world.translation()));
    depth.setTo(9, depth <= 0);
    nearest = cv::min(nearest, depth);
  }
  return nearest;
}

/// The live points as a model in the camera frame, carried by one node.
std::vector<ModelSample> SamplesOf(const LiveView& view, int surface = 0) {
  std::vector<ModelSample> samples;
  for (int v = 0; v < view.depth.rows; v += 2) {
    for (int u = 0; u < view.depth.cols; u += 2) {
      const cv::Vec3f& p = view.map.points(v, u);
      const cv::Vec3f& n = view.map.normals(v, u);
      if (n[2] == 0 || view.labels(v, u) != surface) continue;
      ModelSample sample;
      sample.point = {p[0], p[1], p[2]};
      sample.normal = {n[0], n[1], n[2]};
      sample.u = u, sample.v = v;
      sample.skinning.count = 1;
      sample.skinning.weights[0] = 1;
      samples.push_back(sample);
    }
  }
  return samples;
}

SurfaceTracker MakeTracker(
    const TrackerOptions& options = TrackerOptions::Defaults()) {
  return SurfaceTracker(
      options, SolverOptions(),
      ParseEnergy("point_to_plane(loss=tukey,scale=0.03) arap(weight=8)",
                  BuiltinTerms()));
}

/// The room's corner, tracked from rest to where the camera has moved.
struct CornerTracking {
  explicit CornerTracking(
      const Rigid3d& motion,
      const TrackerOptions& options = TrackerOptions::Defaults()) {
    const LiveView live = View(CornerDepth(motion));
    MakeTracker(options).Track(
        SamplesOf(View(CornerDepth(Rigid3d::Identity()))), live, 0,
        Rigid3d::Identity(), &graph, &report);
  }
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
};

TEST(SurfaceTracker, FindsTheMotionOfTheCamera) {
  const Rigid3d motion = MakeMotion({0.02, -0.03, 0.01}, {0.03, -0.02, 0.02});
  const CornerTracking tracking(motion);
  EXPECT_EQ(tracking.report.state, "tracked");
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
  TrackerOptions options = TrackerOptions::Defaults();
  options.max_translation = 0.01;
  const Rigid3d motion = MakeMotion({0, 0, 0}, {0.03, 0, 0.02});
  const CornerTracking moved(motion, options);
  EXPECT_EQ(moved.report.state, "lost");
  EXPECT_NE(moved.report.reason.find("m from the prediction"),
            std::string::npos)
      << moved.report.reason;
  EXPECT_EQ(moved.graph.motions[0].translation, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(moved.graph.motions[0].rotation, Eigen::Matrix3d::Identity());
  options = TrackerOptions::Defaults();
  options.max_rotation = 0.01;
  const CornerTracking turned(MakeMotion({0, 0.03, 0}, {0, 0, 0}), options);
  EXPECT_EQ(turned.report.state, "lost");
  EXPECT_NE(turned.report.reason.find("degrees from the prediction"),
            std::string::npos)
      << turned.report.reason;
}

TEST(SurfaceTracker, TooFewPointsAreNoTrack) {
  LiveView live = View(CornerDepth(Rigid3d::Identity()));
  const std::vector<ModelSample> samples = SamplesOf(live);
  live.labels.setTo(7);
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
  MakeTracker().Track(samples, live, 0, Rigid3d::Identity(), &graph, &report);
  EXPECT_EQ(report.state, "lost");
  EXPECT_EQ(report.reason.find("only 0 correspondences"), 0u) << report.reason;
  report = SurfaceReport();
  MakeTracker().Track({}, live, 0, Rigid3d::Identity(), &graph, &report);
  EXPECT_EQ(report.state, "lost");
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
  MakeTracker().Track(samples, View(depth), 0, Rigid3d::Identity(), &graph,
                      &report);
  EXPECT_EQ(report.state, "lost");
  EXPECT_NE(report.reason.find("model points fit the depth"), std::string::npos)
      << report.reason;
}

TEST(SurfaceTracker, StartsFromThePredictionIfThatFitsBetter) {
  // 25 cm are beyond the gates; the prediction is 1 cm off.
  const Rigid3d motion = MakeMotion({0, 0, 0}, {0, 0, 0.25});
  const LiveView live = View(CornerDepth(motion));
  DeformationGraph graph = MakeRigidGraph(MakeMotion({0, 0, 0}, {0, 0, 0.24}));
  SurfaceReport report;
  MakeTracker().Track(SamplesOf(View(CornerDepth(Rigid3d::Identity()))), live,
                      0, MakeMotion({0, 0, 0}, {0, 0, -0.24}), &graph, &report);
  EXPECT_EQ(report.state, "tracked") << report.reason;
  EXPECT_LT(
      (MeanRigidMotion(graph).translation() - motion.translation()).norm(),
      0.002);
}

TEST(SurfaceTracker, DoesNotFollowAPredictionThatFitsWorse) {
  const LiveView live = View(CornerDepth(Rigid3d::Identity()));
  DeformationGraph graph =
      MakeRigidGraph(MakeMotion({0, 0, 0}, {0.05, 0, 0.25}));
  SurfaceReport report;
  MakeTracker().Track(SamplesOf(live), live, 0,
                      MakeMotion({0, 0, 0}, {-0.05, 0, -0.25}), &graph,
                      &report);
  EXPECT_EQ(report.state, "tracked") << report.reason;
  EXPECT_LT(MeanRigidMotion(graph).translation().norm(), 0.001);
}

TEST(SurfaceTracker, BendsANonRigidSurfaceOntoTheDepth) {
  // Waves keep the sheet from sliding along itself.
  const auto waves = [](double x, double y) {
    return Eigen::Vector3d(x - 0.25, y - 0.2,
                           1 + 0.03 * std::sin(14 * x) * std::cos(16 * y));
  };
  const auto bend = [](const Eigen::Vector3d& p) { return Bend(p, 1, 0.8); };
  const TriangleMesh rest = SheetMesh(0.5, 0.4, 0.01, waves);
  DeformationGraph graph = CoverWithNodes(rest, 0.04);
  const SkinningIndex index(graph, 6);
  std::vector<ModelSample> samples = SamplesOf(View(MeshDepth(Camera(), rest)));
  for (ModelSample& s : samples) s.skinning = index.Skin(s.point);
  const LiveView live = View(
      MeshDepth(Camera(), SheetMesh(0.5, 0.4, 0.01, [&](double x, double y) {
                  return bend(waves(x, y));
                })));
  SurfaceReport report;
  MakeTracker().Track(samples, live, 0, Rigid3d::Identity(), &graph, &report);
  ASSERT_EQ(report.state, "tracked") << report.reason;
  const WarpField warp(graph);
  double error = 0, before = 0;
  for (const ModelSample& s : samples) {
    const Eigen::Vector3f truth = bend(s.point.cast<double>()).cast<float>();
    error += (warp.WarpPoint(s.skinning, s.point) - truth).norm();
    before += (s.point - truth).norm();
  }
  EXPECT_LT(error / samples.size(), 0.004);
  EXPECT_GT(before / samples.size(), 0.008);
  double factor = 1e9;
  bool non_rigid = false;
  for (const TrackingRound& round : report.rounds) {
    if (round.stage == "rigid") continue;
    non_rigid = true;
    EXPECT_LE(round.prior_factor, factor) << "annealing must soften";
    factor = round.prior_factor;
  }
  EXPECT_TRUE(non_rigid);
  EXPECT_LT(factor, 2);
}

TEST(TrackerOptions, RefuseValuesOutOfRange) {
  const auto refused = [](auto set, const std::string& message) {
    TrackerOptions options = TrackerOptions::Defaults();
    set(&options);
    ExpectInputError([&] { MakeTracker(options); }, message);
  };
  refused([](TrackerOptions* o) { o->rigid.clear(); },
          "rigid stages = 0: expected at least one");
  refused([](TrackerOptions* o) { o->non_rigid.clear(); },
          "non_rigid stages = 0: expected at least one");
  refused([](TrackerOptions* o) { o->rigid[0].stride = 0; },
          "stride = 0: expected 1..32 pixels");
  refused([](TrackerOptions* o) { o->rigid[0].rounds = -1; },
          "rounds = -1: expected >= 0");
  refused([](TrackerOptions* o) { o->rigid[0].gates.distance = -1; },
          "gate distance = -1");
  refused([](TrackerOptions* o) { o->prior_anneal = 0.5; },
          "prior_anneal = 0.5: expected >= 1");
  refused([](TrackerOptions* o) { o->min_correspondences = 5; },
          "min_correspondences = 5: expected >= 6");
  refused([](TrackerOptions* o) { o->min_accepted = 2; },
          "min_accepted = 2: expected 0..1");
  refused([](TrackerOptions* o) { o->max_translation = 0; },
          "max_translation = 0: expected metres > 0");
  refused([](TrackerOptions* o) { o->max_rotation = 0; },
          "max_rotation = 0: expected radians > 0");
}

}  // namespace
}  // namespace splitfusion
