#include "splitfusion/lib/model/refuted_parts.h"

#include <gtest/gtest.h>

#include "support/sample_depth.h"

namespace splitfusion {
namespace {

/// Two nodes, each with one point; all pixels show surface 1 at `depth`.
class RefutedPartsTest : public testing::Test {
 protected:
  void Look(float depth, int label = 1) {
    LiveView live = MakeLiveView(SmallCamera(), WallDepth(SmallCamera(), depth),
                                 PlainColor(SmallCamera(), {1, 2, 3}));
    live.labels.setTo(label);
    std::vector<Skinning> skinning(2);
    for (int i = 0; i < 2; ++i) {
      skinning[i].count = 1;
      skinning[i].nodes[0] = i;
      skinning[i].weights[0] = 1;
    }
    parts_.Look(live, 1, {{0, 0, 1.0f}, {0.1f, 0, 1.4f}}, skinning, 2, 0.02);
  }

  RefutedParts parts_;
};

using Nodes = std::vector<char>;

TEST_F(RefutedPartsTest, CountsFramesOnEnd) {
  Look(1.4f);
  EXPECT_EQ(parts_.Nodes(1), (Nodes{1, 0}));
  EXPECT_EQ(parts_.Nodes(2), (Nodes{0, 0}));
  Look(1.4f);
  EXPECT_EQ(parts_.Nodes(2), (Nodes{1, 0}));
  Look(1.0f);  // The first is there again.
  EXPECT_EQ(parts_.Nodes(1), (Nodes{0, 0}));
}

TEST_F(RefutedPartsTest, TellsThoseInDoubtFromThoseRefuted) {
  Look(1.4f);
  EXPECT_EQ(parts_.Nodes(1, 2), (Nodes{1, 0}));
  Look(1.4f);
  EXPECT_EQ(parts_.Nodes(1, 2), (Nodes{0, 0}));
}

TEST_F(RefutedPartsTest, ANodeThatCarriesNothingIsNotRefuted) {
  Look(1.4f);
  const LiveView live =
      MakeLiveView(SmallCamera(), WallDepth(SmallCamera(), 1.4),
                   PlainColor(SmallCamera(), {1, 2, 3}));
  parts_.Look(live, 1, {}, {}, 2, 0.02);
  EXPECT_EQ(parts_.Nodes(1), (Nodes{0, 0}));
}

TEST_F(RefutedPartsTest, WhatIsHiddenStaysAsItIs) {
  Look(1.4f);
  Look(0.7f);
  EXPECT_EQ(parts_.Nodes(1), (Nodes{1, 0}));
  Look(1.4f);
  EXPECT_EQ(parts_.Nodes(2), (Nodes{1, 0}));
}

TEST_F(RefutedPartsTest, AnotherSurfaceRefutesFromBehindOnly) {
  Look(1.0f, 2);
  EXPECT_EQ(parts_.Nodes(1), (Nodes{0, 0}));
  Look(1.4f, 2);
  EXPECT_EQ(parts_.Nodes(1), (Nodes{1, 0}));
  Look(1.0f, 2);  // That another one is there does not bring it back.
  EXPECT_EQ(parts_.Nodes(1), (Nodes{1, 0}));
}

TEST_F(RefutedPartsTest, BeginsAnewWithWhatWasForgotten) {
  Look(1.6f);
  Look(1.6f);
  EXPECT_EQ(parts_.Nodes(2), (Nodes{1, 1}));
  parts_.Forget({1, 0});
  EXPECT_EQ(parts_.Nodes(1), (Nodes{0, 1}));
  parts_.Follow({2, {1}, 1});  // The new node has a count, too.
  EXPECT_EQ(parts_.Nodes(1), (Nodes{1, 0}));
}

}  // namespace
}  // namespace splitfusion
