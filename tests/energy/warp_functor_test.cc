#include "splitfusion/lib/energy/warp_functor.h"

#include <gtest/gtest.h>

#include "support/gradient_check.h"
#include "support/sample_graphs.h"
#include "support/sample_meshes.h"

namespace splitfusion {
namespace {

/// The warped point itself.
struct Identity {
  static constexpr int kResiduals = 3;
  template <typename T>
  bool operator()(const T* x, T* residual) const {
    for (int d = 0; d < 3; ++d) residual[d] = x[d];
    return true;
  }
};

struct NeverDefined {
  static constexpr int kResiduals = 1;
  template <typename T>
  bool operator()(const T*, T*) const {
    return false;
  }
};

class WarpFunctorTest : public ::testing::Test {
 protected:
  WarpFunctorTest()
      : graph_(CoverWithNodes(PlateMesh(0.2, 0.2, 0.01, 1), 0.04)) {
    Shake(0.2, /*seed=*/1, &graph_);
    skinning_ = SkinningIndex(graph_, 6).Skin(point_);
  }

  std::unique_ptr<ceres::CostFunction> Cost() const {
    return AutoDiffOverTwists(
        WarpFunctor<Identity>(graph_, skinning_, point_, Identity()),
        skinning_.count, 3);
  }

  const Eigen::Vector3f point_{0.11f, 0.07f, 1.f};
  DeformationGraph graph_;
  Skinning skinning_;
};

TEST_F(WarpFunctorTest, IsTheWarpFieldAfterComposingTheTwists) {
  const auto twists = RandomTwists(skinning_.count, 0.4, /*seed=*/2);
  const std::vector<double> x = Residuals(*Cost(), twists);
  for (int k = 0; k < skinning_.count; ++k) {
    NodeMotion& motion = graph_.motions[skinning_.nodes[k]];
    motion.rotation =
        ExpSo3(Eigen::Vector3d(twists[k].data())) * motion.rotation;
    motion.translation += Eigen::Vector3d(twists[k].data() + 3);
  }
  const Eigen::Vector3f expected =
      WarpField(graph_).WarpPoint(skinning_, point_);
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(x[d], expected[d], 1e-6);
}

TEST_F(WarpFunctorTest, GradientsMatchNumeric) {
  for (const double size : {0.0, 1e-7, 0.1, 2.0}) {
    EXPECT_GRADIENTS_MATCH(*Cost(),
                           RandomTwists(skinning_.count, size, /*seed=*/3));
  }
}

TEST_F(WarpFunctorTest, PassesOnThatAResidualIsNotDefined) {
  const auto cost = AutoDiffOverTwists(
      WarpFunctor<NeverDefined>(graph_, skinning_, point_, NeverDefined()),
      skinning_.count, 1);
  EXPECT_TRUE(Residuals(*cost, RandomTwists(skinning_.count, 0, 1)).empty());
}

}  // namespace
}  // namespace splitfusion
