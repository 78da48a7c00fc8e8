#include "splitfusion/lib/visibility/seen_nodes.h"

#include <gtest/gtest.h>

namespace splitfusion {
namespace {

TEST(SeenShares, AddUpTheWeightsOfTheirPoints) {
  std::vector<Correspondence> correspondences(10);
  for (Correspondence& c : correspondences) {
    c.model.skinning.count = 2;
    c.model.skinning.nodes[0] = 1;
    c.model.skinning.nodes[1] = 3;
    c.model.skinning.weights[0] = 0.9f;
    c.model.skinning.weights[1] = 0.1f;
  }
  const std::vector<double> shares = SeenShares(correspondences, 5);
  ASSERT_EQ(shares.size(), 5u);
  EXPECT_EQ(shares[0], 0);
  EXPECT_EQ(shares[1], 1) << "nine points are more than enough";
  EXPECT_EQ(shares[2], 0);
  EXPECT_NEAR(shares[3], 1 / kSeenPoints, 1e-6);
  EXPECT_EQ(shares[4], 0);
}

}  // namespace
}  // namespace splitfusion
