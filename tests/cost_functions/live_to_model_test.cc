#include "splitfusion/cost_functions/live_to_model.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/energy/warp_functor.h"
#include "support/gradient_check.h"
#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kOptions{"live_to_model", 1, LossKind::kTrivial, 0.01};

std::vector<Correspondence> PlateMovedBy(const Eigen::Vector3d& way) {
  return PerfectAssociation(
      PlateMesh(0.1, 0.1, 0.02, 1), MakeRigidGraph(Rigid3d::Identity()),
      [&](const Eigen::Vector3d& p) -> Eigen::Vector3d { return p + way; });
}

TEST(LiveToModel, ValueByHand) {
  const LiveToModel functor{{0, 0.6, 0.8}, {1, 2, 3}, 2};
  const Eigen::Vector3d x(7, 1, 2);
  double residual = 0;
  functor(x.data(), &residual);
  EXPECT_NEAR(residual, 2 * (-0.6 - 0.8), 1e-12);
}

TEST(LiveToModel, GradientsMatchNumeric) {
  DeformationGraph graph = CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04);
  Shake(0.1, /*seed=*/1, &graph);
  const Eigen::Vector3f point(0.11f, 0.07f, 1.f);
  const Skinning skinning = SkinningIndex(graph, 6).Skin(point);
  const LiveToModel functor{Eigen::Vector3d(1, -2, 2) / 3, {0.3, 0.1, 1.1}, 1};
  const auto cost = AutoDiffOverTwists(
      WarpFunctor<LiveToModel>{graph, skinning, point, functor}, skinning.count,
      1);
  for (const double size : {0.0, 0.01, 1.0}) {
    EXPECT_GRADIENTS_MATCH(*cost,
                           RandomTwists(skinning.count, size, /*seed=*/7));
  }
}

TEST(LiveToModelTerm, IsTheSquaredDistanceWhereverTheCameraIs) {
  const std::vector<Correspondence> none;
  for (const Rigid3d& motion :
       {Rigid3d::Identity(), MakeMotion({0.3, 1, -0.2}, {1, 2, 0.5})}) {
    std::vector<Correspondence> lost = PlateMovedBy({0.03, 0, 0.04});
    for (Correspondence& pair : lost) {
      pair.target = motion.cast<float>() * pair.target;
    }
    const DeformationGraph graph = MakeRigidGraph(motion);
    const AddedResiduals added = ResidualsOf(
        LiveToModelTerm(),
        {graph, none, PinholeCamera(), nullptr, nullptr, 1, &lost}, kOptions);
    EXPECT_EQ(added.residual_vectors, static_cast<int>(lost.size()));
    EXPECT_NEAR(EnergyOf(graph, added.residuals), 25, 1e-3);
  }
}

TEST(LiveToModelTerm, APairIsWorthACorrespondence) {
  const std::vector<Correspondence> found = PlateMovedBy({0, 0, 0});
  std::vector<Correspondence> lost = PlateMovedBy({0.05, 0, 0});
  lost.resize(found.size() / 3);
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const AddedResiduals added = ResidualsOf(
      LiveToModelTerm(),
      {graph, found, PinholeCamera(), nullptr, nullptr, 1, &lost}, kOptions);
  EXPECT_NEAR(EnergyOf(graph, added.residuals),
              25.0 * lost.size() / (found.size() + lost.size()), 1e-3);
}

TEST(LiveToModelTerm, IsNothingWithoutPairs) {
  const std::vector<Correspondence> found = PlateMovedBy({0.1, 0, 0});
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  EXPECT_EQ(
      ResidualsOf(LiveToModelTerm(), {graph, found, PinholeCamera()}, kOptions)
          .residual_vectors,
      0);
}

}  // namespace
}  // namespace splitfusion
