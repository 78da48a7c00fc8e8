// Energy terms of one's own that look at the live frame and at the motions of
// the frame before.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "pipelines/tracking_scenes.h"
#include "splitfusion/lib/energy/energy_term.h"

namespace splitfusion {
namespace {

/// Smoothness in time: how far a node has come since the frame before.
///
///   r = t + tau - t_before, camera frame, metres
struct Travel {
  static constexpr int kResiduals = 3;
  Eigen::Vector3d travelled;  ///< t - t_before.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    for (int d = 0; d < 3; ++d) {
      residual[d] = T(travelled[d]) + twists[0][3 + d];
    }
    return true;
  }
};

class TravelTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    ASSERT_NE(input.live, nullptr);
    EXPECT_EQ(input.live->color.cols, input.camera.width);
    ASSERT_NE(input.before, nullptr);
    ASSERT_EQ(input.before->size(), input.graph.motions.size());
    std::vector<std::vector<int>> nodes;
    std::vector<Travel> functors;
    for (int i = 0; i < input.graph.size(); ++i) {
      nodes.push_back({i});
      functors.push_back({input.graph.motions[i].translation -
                          (*input.before)[i].translation});
    }
    sink->AddNodes(nodes, functors);
  }
};

/// A tracker whose energy all but forbids nodes to travel.
SurfaceTracker MakeSluggishTracker() {
  TermRegistry terms = BuiltinTerms();
  terms.Register("travel", [] { return std::make_unique<TravelTerm>(); });
  return MakeTracker(TrackerOptions(), "travel(weight=1e5)", terms);
}

TEST(TermInput, ATermMayHoldARigidSurfaceWhereItWas) {
  // The prediction is right; a term of smoothness in time wants it back.
  const Rigid3d motion = MakeMotion({0, 0, 0}, {0, 0, 0.03});
  const LiveView live = View(CornerDepth(motion));
  const std::vector<ModelSample> samples =
      SamplesOf(View(CornerDepth(Rigid3d::Identity())));
  const auto moved = [&](const SurfaceTracker& tracker) {
    DeformationGraph graph = MakeRigidGraph(motion);
    SurfaceReport report;
    tracker.Track(samples, {}, live, 0, motion.inverse(), &graph, &report);
    EXPECT_EQ(ToString(report.state), "tracked") << report.reason;
    return graph.motions[0].translation.norm();
  };
  EXPECT_NEAR(moved(MakeTracker()), 0.03, 0.001);
  // Not 0: the term leaves turns free.
  EXPECT_LT(moved(MakeSluggishTracker()), 0.003);
}

/// A valley with flat walls, whose Gauss-Newton steps shoot over the bottom.
///
///   r = atan(kSteepness (t_x + tau_x - kBottom)), camera frame
struct Valley {
  static constexpr int kResiduals = 1;
  static constexpr double kSteepness = 100, kBottom = 0.05;
  double x;  ///< t_x.
  template <typename T>
  bool operator()(T const* const* twists, T* residual) const {
    residual[0] = atan(T(kSteepness) * (T(x - kBottom) + twists[0][3]));
    return true;
  }
};

class ValleyTerm : public EnergyTerm {
 public:
  void AddResiduals(const EnergyInput& input,
                    ResidualSink* sink) const override {
    sink->AddNodes(
        {{0}}, std::vector<Valley>{{input.graph.motions[0].translation.x()}});
  }
};

TEST(TermInput, TheTrustRegionOfARoundGoesOnFromTheRoundBefore) {
  TermRegistry terms = BuiltinTerms();
  terms.Register("valley", [] { return std::make_unique<ValleyTerm>(); });
  const LiveView live = View(CornerDepth(Rigid3d::Identity()));
  DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  SurfaceReport report;
  MakeTracker(TrackerOptions(), "valley(weight=1)", terms)
      .Track(SamplesOf(live), {}, live, 0, Rigid3d::Identity(), &graph,
             &report);
  const double first = SolverOptions().initial_radius;
  ASSERT_GT(report.rounds.size(), 1u);
  double radius = first;
  bool shrank = false;
  for (const TrackingRound& round : report.rounds) {
    const std::vector<SolverIteration>& steps = round.solver.iterations;
    ASSERT_FALSE(steps.empty());
    EXPECT_EQ(steps.front().trust_region_radius, std::min(first, radius));
    radius = steps.back().trust_region_radius;
    shrank = shrank || radius < first;
  }
  EXPECT_TRUE(shrank) << "no step was too long";
}

/// Adds nothing; notes the annealing that it is told.
class AnnealNotes : public EnergyTerm {
 public:
  explicit AnnealNotes(std::vector<double>* notes) : notes_(notes) {}

  void AddResiduals(const EnergyInput& input, ResidualSink*) const override {
    notes_->push_back(input.anneal);
  }

 private:
  std::vector<double>* notes_;
};

TEST(TermInput, ATermIsToldTheAnnealing) {
  std::vector<double> notes;
  TermRegistry terms = BuiltinTerms();
  terms.Register("notes",
                 [&notes] { return std::make_unique<AnnealNotes>(&notes); });
  TrackerOptions options;
  options.prior_anneal = 6;
  BendingSheet sheet;
  SurfaceReport report;
  MakeTracker(options, "notes(weight=1)", terms)
      .Track(sheet.samples, {}, sheet.live, 0, Rigid3d::Identity(),
             &sheet.graph, &report);
  ASSERT_FALSE(notes.empty());
  EXPECT_EQ(notes.front(), 1);  // Of the rigid rounds.
  EXPECT_NEAR(*std::max_element(notes.begin(), notes.end()), 6, 1e-12);
  EXPECT_NEAR(notes.back(), 1, 1e-12);
}

TEST(TermInput, ATermMayHoldTheNodesWhereTheyWere) {
  const auto farthest = [](const SurfaceTracker& tracker) {
    BendingSheet sheet;
    const Rigid3d motion = MakeMotion({0, 0, 0}, {0, 0.004, 0});
    const DeformationGraph rest = sheet.graph;
    ApplyRigidMotion(motion, &sheet.graph);  // The prediction.
    SurfaceReport report;
    tracker.Track(sheet.samples, {}, sheet.live, 0, motion.inverse(),
                  &sheet.graph, &report);
    EXPECT_EQ(ToString(report.state), "tracked") << report.reason;
    double distance = 0;
    for (int i = 0; i < rest.size(); ++i) {
      distance = std::max(distance, (sheet.graph.motions[i].translation -
                                     rest.motions[i].translation)
                                        .norm());
    }
    return distance;
  };
  EXPECT_GT(farthest(MakeTracker()), 0.02);
  EXPECT_LT(farthest(MakeSluggishTracker()), 0.001);
}

}  // namespace
}  // namespace splitfusion
