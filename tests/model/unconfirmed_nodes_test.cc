#include "splitfusion/lib/model/unconfirmed_nodes.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/sample_depth.h"

namespace splitfusion {
namespace {

constexpr int kLookedAt = 1;
constexpr double kTruncation = 0.03;

using Nodes = std::vector<char>;

const Eigen::Vector3f kSeen = {0, 0, 2};
const Eigen::Vector3f kWithinTruncation = {0.1f, 0, 2.02f};
const Eigen::Vector3f kInside = {0.1f, 0, 2.1f};
const Eigen::Vector3f kBehindOther = {0.7f, 0, 2};
const Eigen::Vector3f kOutside = {5, 0, 2};

/// Surface 1 fills the image 2 m from the camera, but for the right quarter,
/// where surface 2 stands 1 m from it.
class UnconfirmedNodesTest : public testing::Test {
 protected:
  UnconfirmedNodesTest() {
    const PinholeCamera camera = SmallCamera();
    live_ = MakeLiveView(camera, WallDepth(camera, 2),
                         PlainColor(camera, {1, 2, 3}));
    live_.labels.setTo(kLookedAt);
    const int right = camera.width * 3 / 4;
    live_.depth.colRange(right, camera.width) = 1;
    live_.labels.colRange(right, camera.width) = 2;
  }

  void Look(const std::vector<Eigen::Vector3f>& places, int frames) {
    for (int i = 0; i < frames; ++i) {
      std::vector<char> shown;
      for (const Eigen::Vector3f& place : places) {
        shown.push_back(place == kSeen);
      }
      nodes_.Look(live_, kLookedAt, places, shown,
                  std::vector<char>(places.size(), facing_), kTruncation);
    }
  }

  bool facing_ = true;
  LiveView live_;
  UnconfirmedNodes nodes_;
};

TEST_F(UnconfirmedNodesTest, WhatTheSurfaceItselfHidesIsForgottenInTime) {
  Look({kSeen, kSeen}, 4);
  Look({kSeen, kInside}, 19);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, false}));
  Look({kSeen, kInside}, 1);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, true}));
  EXPECT_EQ(nodes_.Nodes(0, 20), Nodes({false, false}));
}

TEST_F(UnconfirmedNodesTest, WhatLiesUponWhatIsShownIsHiddenByIt) {
  Look({kSeen, kWithinTruncation}, 19);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, false}));
  Look({kSeen, kWithinTruncation}, 1);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, true}));
}

TEST_F(UnconfirmedNodesTest, WhatWasSeenOftenIsConfirmed) {
  Look({kSeen, kInside}, 8);
  EXPECT_EQ(nodes_.Confirmed(8), Nodes({true, false}));
  EXPECT_EQ(nodes_.Confirmed(9), Nodes({false, false}));
  EXPECT_EQ(nodes_.Confirmed(0), Nodes({false, false}));
}

TEST_F(UnconfirmedNodesTest, WhatWasSeenForLongIsBelievedForLonger) {
  Look({kSeen}, 8);
  Look({kInside}, 39);
  EXPECT_EQ(nodes_.Nodes(4, 20), Nodes({false}));
  EXPECT_EQ(nodes_.Nodes(9, 20), Nodes({true}));
  Look({kInside}, 1);
  EXPECT_EQ(nodes_.Nodes(4, 20), Nodes({true}));
}

TEST_F(UnconfirmedNodesTest, AFewSightsDoNotSaveWhatIsMostlyHidden) {
  for (int i = 0; i < 9; ++i) {
    Look({kInside}, 5);
    Look({kSeen}, 1);
  }
  EXPECT_EQ(nodes_.Nodes(9, 45), Nodes({true}));
  EXPECT_EQ(nodes_.Nodes(9, 46), Nodes({false}));
}

TEST_F(UnconfirmedNodesTest, WhatWasSeenFromTheOtherSideIsKept) {
  Look({kSeen}, 8);
  facing_ = false;
  Look({kInside}, 1000);
  EXPECT_EQ(nodes_.Nodes(4, 20), Nodes({false}));
  EXPECT_EQ(nodes_.Nodes(9, 20), Nodes({true}));
}

TEST_F(UnconfirmedNodesTest, WhatOthersHideOrIsOutsideWaits) {
  Look({kSeen, kBehindOther, kOutside}, 30);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, false, false}));
}

TEST_F(UnconfirmedNodesTest, ASightBeginsTheWaitAnew) {
  Look({kInside}, 19);
  Look({kSeen}, 1);
  Look({kInside}, 19);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false}));
  Look({kInside}, 1);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({true}));
}

TEST_F(UnconfirmedNodesTest, FollowsTheGraph) {
  Look({kSeen, kInside}, 20);
  NodeChange change{2, {1}, 1};
  nodes_.Follow(change);
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({true, false}));
  nodes_.Forget({true, false});
  EXPECT_EQ(nodes_.Nodes(10, 20), Nodes({false, false}));
}

}  // namespace
}  // namespace splitfusion
