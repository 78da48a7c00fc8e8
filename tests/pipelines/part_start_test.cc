#include "splitfusion/pipelines/part_start.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/lib/base/thread_limit.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

constexpr double kShoulder = 0.1;  // Column of space about which it swings.

/// An arm, 4 cm wide, on a body, and the view of it after it was swung, by 0.17
/// m at the tip, within one frame.
class SwungArm {
 public:
  SwungArm() : graph_(CoverWithNodes(rest_, 0.03)), index_(graph_, 6) {
    samples_ = SamplesOf(ViewOf(rest_), 1);
    for (ModelSample& s : samples_) s.skinning = index_.Skin(s.point);
    live_ = ViewOf(Sheet(kSwing));
    // A match in every third point, and of the arm every eighth is wrong.
    for (std::size_t i = 0; i < samples_.size(); i += 3) {
      const Eigen::Vector3f& from = samples_[i].point;
      Eigen::Vector3f to = Swung(from.cast<double>()).cast<float>();
      if (from.x() > kShoulder && i % 24 == 0) to.y() += 0.1f;
      motions_.push_back({from, to});
    }
  }

  /// Mean distance of the outer arm from its place after it was tracked, with
  /// or without the matches, metres.
  double ErrorAfterTracking(const std::vector<PointMotion>& motions,
                            SurfaceReport* report,
                            const TrackerOptions& options = {}) {
    DeformationGraph graph = graph_;
    const SurfaceTracker tracker =
        MakeTracker(options,
                    "live_to_model(weight=1,loss=huber,scale=0.013) "
                    "temporal_arap(weight=8)");
    EXPECT_TRUE(tracker.Track(samples_, {}, live_, 1, Rigid3d::Identity(),
                              &graph, report, {}, motions))
        << report->reason;
    tracked_ = graph.motions;
    return ErrorOf(graph);
  }

  /// The same of a graph.
  double ErrorOf(const DeformationGraph& graph) const {
    const WarpField warp(graph);
    double sum = 0;
    int count = 0;
    for (const ModelSample& s : samples_) {
      if (s.point.x() < kShoulder + 0.1) continue;
      sum += (warp.WarpPoint(s.skinning, s.point).cast<double>() -
              Swung(s.point.cast<double>()))
                 .norm();
      ++count;
    }
    return sum / count;
  }

  /// Where the arm starts by the matches, judged by the truth.
  PartStart Start(DeformationGraph* graph) const {
    const PartStarter::Misfit misfit =
        [](const std::vector<ModelSample>& samples,
           const DeformationGraph& there) {
          const WarpField warp(there);
          double sum = 0;
          for (const ModelSample& s : samples) {
            sum += (warp.WarpPoint(s.skinning, s.point).cast<double>() -
                    Swung(s.point.cast<double>()))
                       .norm();
          }
          return sum;
        };
    const std::unique_ptr<Solver> solver =
        BuiltinSolvers().Make("gn_pcg", SolverOptions());
    return PartStarter(PartStartOptions(), *solver)
        .Start({samples_, motions_, live_.camera, graph_, misfit}, graph);
  }

  const DeformationGraph& graph() const { return graph_; }
  const std::vector<PointMotion>& motions() const { return motions_; }
  const std::vector<NodeMotion>& tracked() const { return tracked_; }

 private:
  static constexpr double kSwing = 0.7;  // Radians.

  static Eigen::Vector3d Swung(const Eigen::Vector3d& p,
                               double swing = kSwing) {
    if (p.x() <= kShoulder) return p;
    const double along = p.x() - kShoulder;
    return {kShoulder + std::cos(swing) * along - std::sin(swing) * p.y(),
            std::sin(swing) * along + std::cos(swing) * p.y(), p.z()};
  }

  static TriangleMesh Sheet(double swing) {
    TriangleMesh mesh = SheetMesh(
        0.35, 0.04, 0.005, [swing](double x, double y) -> Eigen::Vector3d {
          return Swung({x, y, 1 + 0.01 * std::cos(60 * y)}, swing);
        });
    AppendMesh(SheetMesh(0.3, 0.4, 0.01,
                         [](double x, double y) -> Eigen::Vector3d {
                           return {
                               x - 0.2, y - 0.2,
                               1 + 0.03 * std::sin(14 * x) * std::cos(16 * y)};
                         }),
               &mesh);
    return mesh;
  }

  static LiveView ViewOf(const TriangleMesh& mesh) {
    cv::Mat_<float> depth = MeshDepth(Camera(), mesh);
    const cv::Mat_<uchar> seen = depth > 0;
    depth.setTo(2, depth == 0);  // A wall behind it.
    LiveView live = View(depth);
    live.labels.setTo(1, seen);
    return live;
  }

  TriangleMesh rest_ = Sheet(0);
  DeformationGraph graph_;
  SkinningIndex index_;
  std::vector<ModelSample> samples_;
  LiveView live_;
  std::vector<PointMotion> motions_;
  std::vector<NodeMotion> tracked_;
};

TEST(PartStarter, MovesAnArmToWhereItsPointsWereMatched) {
  SwungArm arm;
  EXPECT_GT(arm.ErrorOf(arm.graph()), 0.1);
  DeformationGraph graph = arm.graph();
  EXPECT_EQ(arm.Start(&graph).parts, 1);
  EXPECT_LT(arm.ErrorOf(graph), 0.006);
}

TEST(PartStarter, FindsAnArmThatMovedFartherThanTheGates) {
  SwungArm arm;
  SurfaceReport without, with;
  const double left_behind = arm.ErrorAfterTracking({}, &without);
  EXPECT_GT(left_behind, 0.06);
  EXPECT_EQ(without.started_parts, 0);
  // The sheet has no texture that holds it along itself.
  EXPECT_LT(arm.ErrorAfterTracking(arm.motions(), &with), 0.6 * left_behind);
  EXPECT_EQ(with.started_parts, 1);
}

TEST(PartStarter, DoesNothingWhereItIsSwitchedOff) {
  SwungArm arm;
  TrackerOptions off;
  off.part_start.parts.count = 0;
  SurfaceReport report;
  EXPECT_GT(arm.ErrorAfterTracking(arm.motions(), &report, off), 0.06);
  EXPECT_EQ(report.started_parts, 0);
}

TEST(PartStarter, DoesNotBelieveMatchesThatDoNotFitTheDepth) {
  SwungArm arm;
  std::vector<PointMotion> wrong = arm.motions();
  for (PointMotion& motion : wrong) {
    motion.to = motion.from;
    if (motion.from.x() > kShoulder) motion.to.y() -= 0.15f;
  }
  SurfaceReport without, with;
  const double error = arm.ErrorAfterTracking({}, &without);
  EXPECT_NEAR(arm.ErrorAfterTracking(wrong, &with), error, 1e-9);
  EXPECT_EQ(with.started_parts, 0);
}

TEST(PartStarter, DoesNotDependOnTheNumberOfThreads) {
  SwungArm arm;
  SurfaceReport report;
  arm.ErrorAfterTracking(arm.motions(), &report);
  const std::vector<NodeMotion> many = arm.tracked();
  const ThreadLimit one(1);
  arm.ErrorAfterTracking(arm.motions(), &report);
  ASSERT_EQ(many.size(), arm.tracked().size());
  for (std::size_t i = 0; i < many.size(); ++i) {
    EXPECT_EQ(many[i].translation, arm.tracked()[i].translation);
  }
}

TEST(PartStartOptions, RefuseValuesOutOfRange) {
  TrackerOptions options;
  options.part_start.gain = 1.5;
  ExpectInputError([&] { MakeTracker(options); }, "part_gain = 1.5");
  options.part_start.gain = 0.85;
  options.part_start.parts.min_points = 3;
  ExpectInputError([&] { MakeTracker(options); }, "part_min_points = 3");
}

}  // namespace
}  // namespace splitfusion
