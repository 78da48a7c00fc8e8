#include "splitfusion/cost_functions/tracks.h"

#include <gtest/gtest.h>

#include "splitfusion/cost_functions/builtin_terms.h"
#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kTracks{"tracks", 1, LossKind::kTrivial, 0.01};

Eigen::Vector3d Value(const TrackDistance& track, const Eigen::Vector3d& x) {
  Eigen::Vector3d residual;
  track(x.data(), residual.data());
  return residual;
}

TEST(TrackDistance, IsTheWayAcrossTheView) {
  const Eigen::Vector3d target(0.2, -0.1, 2);
  const Eigen::Vector3d x = target + Eigen::Vector3d(0.03, -0.04, 0);
  EXPECT_TRUE(Value({target, 1}, x).isApprox(Eigen::Vector3d(0.03, -0.04, 0)));
  EXPECT_TRUE(
      Value({target, 0.5}, x).isApprox(Eigen::Vector3d(0.015, -0.02, 0)));
}

TEST(TrackDistance, IsTheDifferenceOfDepthAlongTheRay) {
  const Eigen::Vector3d target(0.2, -0.1, 2);
  for (const double stretch : {0.5, 0.9, 3.0}) {
    const double deeper = 2 * (stretch - 1);
    EXPECT_TRUE(Value({target, 1}, stretch * target)
                    .isApprox(Eigen::Vector3d(0, 0, deeper)));
    EXPECT_TRUE(Value({target, 0.5, 3}, stretch * target)
                    .isApprox(Eigen::Vector3d(0, 0, 1.5 * deeper)));
    EXPECT_LT(Value({target, 1, 0}, stretch * target).norm(), 1e-12);
  }
}

TEST(TrackDistance, GradientsMatchNumeric) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.05, /*seed=*/1, &graph);
  const Eigen::Vector3f point(0.11f, -0.07f, 1);
  const Skinning skinning = SkinningIndex(graph, 6).Skin(point);
  const auto cost = AutoDiffOverTwists(
      WarpFunctor<TrackDistance>(graph, skinning, point,
                                 {{0.1, -0.06, 1.1}, 0.7, 0.8}),
      skinning.count, 3);
  for (const double size : {0.0, 0.01, 0.3}) {
    EXPECT_GRADIENTS_MATCH(*cost,
                           RandomTwists(skinning.count, size, /*seed=*/2));
  }
}

std::vector<TrackedPoint> PointsOf(const std::vector<Correspondence>& pairs) {
  std::vector<TrackedPoint> points;
  for (const Correspondence& pair : pairs) {
    points.push_back({pair.model, pair.target, pair.weight});
  }
  return points;
}

TEST(TracksTerm, ATrackIsWorthACorrespondence) {
  const std::vector<Correspondence> found = PlateMovedBy({0, 0, 0});
  std::vector<TrackedPoint> tracks = PointsOf(PlateMovedBy({0.03, 0.04, 0}));
  tracks.resize(tracks.size() / 3);
  EnergyInput input{MakeRigidGraph(Rigid3d::Identity()), found,
                    PinholeCamera()};
  input.tracks = &tracks;
  const AddedResiduals added = ResidualsOf(TracksTerm(), input, kTracks);
  EXPECT_EQ(added.residual_vectors, static_cast<int>(tracks.size()));
  EXPECT_NEAR(EnergyOf(MakeRigidGraph(Rigid3d::Identity()), added.residuals),
              25.0 * tracks.size() / (found.size() + tracks.size()), 1e-3);
}

TEST(TracksTerm, DepthCountsAsItsKeySays) {
  const std::vector<Correspondence> found = PlateMovedBy({0, 0, 0});
  const std::vector<TrackedPoint> tracks = PointsOf(PlateMovedBy({0, 0, 0.05}));
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  PinholeCamera camera;
  camera.fx = 600;
  EnergyInput input{graph, found, camera};
  input.tracks = &tracks;
  const auto energy = [&](double depth) {
    const Energy terms = ParseEnergy(
        "tracks(depth=" + std::to_string(depth) + ")", BuiltinTerms());
    return EnergyOf(graph,
                    ResidualsOf(*terms[0].term, input, kTracks).residuals);
  };
  const double across = energy(0);  // Deeper, their pixels are others.
  const double z = 1.05, pixel = z / camera.fx;
  const double ratio = pixel / camera.noise.Sigma(z);
  ASSERT_LT(ratio, 1);
  const double along = ratio * ratio * 25.0 / 2;
  EXPECT_NEAR(energy(1), across + along, 1e-3);
  EXPECT_NEAR(energy(3), across + 3 * along, 1e-3);
  camera.fx = 50;  // A pixel tells less than the depth.
  EXPECT_NEAR(energy(1), across + 25.0 / 2, 1e-3);
}

TEST(TracksTerm, IsNothingWithoutTracks) {
  const std::vector<Correspondence> found = PlateMovedBy({0.1, 0, 0});
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  EXPECT_EQ(ResidualsOf(TracksTerm(), {graph, found, PinholeCamera()}, kTracks)
                .residual_vectors,
            0);
}

}  // namespace
}  // namespace splitfusion
