#include "splitfusion/cost_functions/live_to_model.h"

#include <gtest/gtest.h>

#include "support/sample_correspondences.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"
#include "support/term_energy.h"

namespace splitfusion {
namespace {

const TermOptions kLiveToModel{"live_to_model", 1, LossKind::kTrivial, 0.01};

TEST(LiveToModelTerm, IsTheSquaredDistanceWhereverTheCameraIs) {
  const std::vector<Correspondence> none;
  for (const Rigid3d& motion :
       {Rigid3d::Identity(), MakeMotion({0.3, 1, -0.2}, {1, 2, 0.5})}) {
    std::vector<Correspondence> lost = PlateMovedBy({0.03, 0, 0.04});
    for (Correspondence& pair : lost) {
      pair.target = motion.cast<float>() * pair.target;
    }
    const DeformationGraph graph = MakeRigidGraph(motion);
    const AddedResiduals added =
        ResidualsOf(LiveToModelTerm(),
                    {graph, none, PinholeCamera(), nullptr, nullptr, 1, &lost},
                    kLiveToModel);
    EXPECT_EQ(added.residual_vectors, static_cast<int>(lost.size()));
    EXPECT_NEAR(EnergyOf(graph, added.residuals), 25, 1e-3);
  }
}

TEST(LiveToModelTerm, APairIsWorthACorrespondence) {
  const std::vector<Correspondence> found = PlateMovedBy({0, 0, 0});
  std::vector<Correspondence> lost = PlateMovedBy({0.05, 0, 0});
  lost.resize(found.size() / 3);
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  const AddedResiduals added =
      ResidualsOf(LiveToModelTerm(),
                  {graph, found, PinholeCamera(), nullptr, nullptr, 1, &lost},
                  kLiveToModel);
  EXPECT_NEAR(EnergyOf(graph, added.residuals),
              25.0 * lost.size() / (found.size() + lost.size()), 1e-3);
}

TEST(LiveToModelTerm, IsNothingWithoutPairs) {
  const std::vector<Correspondence> found = PlateMovedBy({0.1, 0, 0});
  const DeformationGraph graph = MakeRigidGraph(Rigid3d::Identity());
  EXPECT_EQ(ResidualsOf(LiveToModelTerm(), {graph, found, PinholeCamera()},
                        kLiveToModel)
                .residual_vectors,
            0);
}

}  // namespace
}  // namespace splitfusion
