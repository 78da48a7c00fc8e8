// The brightness of the live image as an unknown of `color`.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/lib/base/median.h"

namespace splitfusion {
namespace {

constexpr double kGain = 1.3, kOffset = -0.1;

/// The corner of a room with waves painted on, brighter by gain and offset.
LiveView PaintedCorner(double gain, double offset) {
  cv::Mat_<cv::Vec3b> color(Camera().height, Camera().width);
  for (int v = 0; v < color.rows; ++v) {
    for (int u = 0; u < color.cols; ++u) {
      const double grey =
          0.45 + 0.15 * std::sin(u / 6.0) + 0.15 * std::cos(v / 7.0 + u / 31.0);
      color(v, u) = cv::Vec3b::all(
          cv::saturate_cast<uchar>(255 * (gain * grey + offset)));
    }
  }
  return MakeLiveView(Camera(), CornerDepth(Rigid3d::Identity()), color);
}

struct Tracked {
  double error = 0;  ///< Of the motion, metres.
  std::vector<TrackingRound> rounds;
};

/// Tracks the corner, whose model is of plain brightness, from a guess that is
/// off, in a live image that is brighter.
Tracked TrackBrighter(const std::vector<ModelSample>& samples,
                      const std::string& color) {
  DeformationGraph graph = MakeRigidGraph(
      MakeMotion({0.002, -0.002, 0.004}, {0.006, -0.004, 0.005}));
  SurfaceReport report;
  const SurfaceTracker tracker = MakeTracker({}, color);
  EXPECT_TRUE(tracker.Track(samples, {}, PaintedCorner(kGain, kOffset), 0,
                            Rigid3d::Identity(), &graph, &report))
      << report.reason;
  return {graph.motions[0].translation.norm(), report.rounds};
}

std::vector<ModelSample> PlainModel() {
  const LiveView plain = PaintedCorner(1, 0);
  std::vector<ModelSample> samples = SamplesOf(plain);
  for (ModelSample& s : samples) {
    s.intensity = {plain.grey[0].value(s.v, s.u),
                   plain.grey[1].value(s.v, s.u)};
  }
  return samples;
}

TEST(Exposure, AKnownGainAndOffsetAreFoundWithTheMotion) {
  const std::vector<ModelSample> samples = PlainModel();
  const Tracked tracked = TrackBrighter(
      samples, "color(weight=8,loss=huber,scale=0.01,exposure=true)");
  EXPECT_LT(tracked.error, 5e-4);
  // Association has taken the median difference out.
  std::vector<float> differences;
  for (const ModelSample& s : samples) {
    differences.push_back(
        static_cast<float>((kGain - 1) * s.intensity[0] + kOffset));
  }
  const double common = Median(std::move(differences));
  ASSERT_FALSE(tracked.rounds.empty());
  const SolverReport& last = tracked.rounds.back().solver;
  ASSERT_EQ(last.unknowns.size(), 2u);
  EXPECT_NEAR(last.unknowns[0].final, kGain, 0.01);
  EXPECT_NEAR(last.unknowns[1].final, kOffset - common, 0.01);
}

TEST(Exposure, ARoundBeginsWhereTheOneBeforeHasEnded) {
  const Tracked tracked =
      TrackBrighter(PlainModel(), "color(weight=8,exposure=true)");
  ASSERT_GT(tracked.rounds.size(), 2u);
  std::vector<double> values = {1, 0};
  for (const TrackingRound& round : tracked.rounds) {
    for (int i = 0; i < 2; ++i) {
      EXPECT_EQ(round.solver.unknowns[i].initial, values[i]);
      values[i] = round.solver.unknowns[i].final;
    }
  }
  EXPECT_NE(values[0], 1);
}

TEST(Exposure, APriorOfManyPointsHoldsIt) {
  const Tracked tracked = TrackBrighter(
      PlainModel(), "color(weight=8,exposure=true,exposure_prior=1e7)");
  EXPECT_NEAR(tracked.rounds.back().solver.unknowns[0].final, 1, 0.01);
  EXPECT_NEAR(tracked.rounds.back().solver.unknowns[1].final, 0, 0.01);
}

TEST(Exposure, IsNotEstimatedUnlessAskedFor) {
  const Tracked tracked = TrackBrighter(PlainModel(), "color(weight=8)");
  for (const TrackingRound& round : tracked.rounds) {
    EXPECT_TRUE(round.solver.unknowns.empty());
    EXPECT_EQ(round.solver.parameters, 6);
  }
}

}  // namespace
}  // namespace splitfusion
