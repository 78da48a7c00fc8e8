#include <gtest/gtest.h>

#include "splitfusion/lib/association/association.h"
#include "support/rejected.h"
#include "support/sample_depth.h"
#include "support/sample_graphs.h"

namespace splitfusion {
namespace {

/// A wall at 1.2 m of which the right half belongs to surface 1.
class ClosestPoint : public ::testing::Test {
 protected:
  ClosestPoint()
      : live_(MakeLiveView(camera_, WallDepth(camera_, 1.2),
                           PlainColor(camera_, {1, 2, 3}))) {
    live_.labels.colRange(80, live_.labels.cols).setTo(1);
  }

  /// Of a model point `in_front` metres before the wall at a pixel.
  Association Run(int u, int v, float in_front, int surface = 0) const {
    ModelSample sample;
    sample.point = camera_.BackProject<float>(u, v, 1.2f);
    sample.point.z() -= in_front;
    sample.normal = {0, 0, -1};
    sample.skinning.count = 1;
    sample.skinning.weights[0] = 1;
    return BuiltinAssociations()
        .Make("closest_point", live_, static_cast<std::uint16_t>(surface))
        ->Associate({sample}, WarpField(graph_), /*stride=*/1,
                    {0.10, 0.52, 1.31, false});
  }

  const PinholeCamera camera_ = SmallCamera();
  LiveView live_;
  const DeformationGraph graph_ = MakeRigidGraph(Rigid3d::Identity());
};

TEST_F(ClosestPoint, IsTheFootOfThePerpendicular) {
  const Association association = Run(40, 30, 0.05f);
  ASSERT_EQ(association.counts.accepted, 1);
  const Correspondence& pair = association.correspondences[0];
  // Not that of the ray of sight, which meets the wall farther out.
  EXPECT_EQ(pair.pixel, Eigen::Vector2f(40, 30));
  EXPECT_LT((pair.target - camera_.BackProject<float>(40, 30, 1.2f)).norm(),
            1e-5);
}

TEST_F(ClosestPoint, IsOfTheSurfaceItself) {
  const Association association = Run(82, 60, 0, /*surface=*/0);
  ASSERT_EQ(association.counts.accepted, 1);
  EXPECT_LT(association.correspondences[0].pixel.x(), 80);
  EXPECT_EQ(Rejected(Run(140, 60, 0).counts, "distance"), 1);
  EXPECT_EQ(Rejected(Run(82, 60, 0, /*surface=*/5).counts, "no_depth"), 1)
      << "a surface that is not in view";
}

TEST_F(ClosestPoint, ReasonsAreItsOwn) {
  const AssociationCounts counts = Run(40, 30, 0.5f).counts;
  EXPECT_EQ(counts.model_points, 1);
  EXPECT_EQ(counts.Count(Rejection::kMisfit), 1);
  EXPECT_EQ(Rejected(counts, "occluded"), 0);
  std::vector<std::string> reasons;
  for (const RejectedPoints& r : counts.rejected) reasons.push_back(r.reason);
  EXPECT_EQ(reasons, (std::vector<std::string>{"no_depth", "distance",
                                               "normal_angle", "grazing"}));
}

}  // namespace
}  // namespace splitfusion
