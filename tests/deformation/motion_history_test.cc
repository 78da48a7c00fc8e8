#include "splitfusion/lib/deformation/motion_history.h"

#include <gtest/gtest.h>

#include <vector>

#include "deformation/sample_motions.h"
#include "support/motion_frames.h"

namespace splitfusion {
namespace {

TEST(MotionHistory, FindsFrames) {
  const MotionHistory history = TwoFrames();
  ASSERT_TRUE(history.Find(5).has_value());
  EXPECT_FALSE(history.Find(5)->tracked);
  EXPECT_FALSE(history.Find(4).has_value());
  EXPECT_FALSE(history.Find(6).has_value());
  EXPECT_TRUE(history.Has(3));
  EXPECT_FALSE(history.Has(6));
  EXPECT_TRUE(history.Tracked(3));
  EXPECT_FALSE(history.Tracked(5)) << "carried over";
  EXPECT_FALSE(history.Tracked(4)) << "there is none";
  EXPECT_FALSE(MotionHistory().Find(0).has_value());
}

TEST(MotionHistory, FramesInItsFileAreAsInMemory) {
  std::vector<FrameMotions> frames;
  for (int f = 0; f < 9; ++f) {
    frames.push_back({2 * f,
                      f % 3 != 0,
                      {Motion(0.1 * f), Motion(0.2)},
                      {0, static_cast<char>(f % 2)},
                      {{0, 1}, {3, 4}}});
  }
  const MotionHistory kept = HistoryOf(frames);
  // Of nine, two fit.
  MotionHistory spooled = HistoryOf(frames, 2 * frames[0].bytes());
  const MotionHistory copy = spooled;
  for (const int i : {0, 5, 5, 8}) {
    EditFrame(
        i, [&](FrameMotions& frame) { frame.motions[1] = Motion(i); },
        &spooled);
  }
  ASSERT_EQ(spooled.size(), 9);
  for (int i = 0; i < 9; ++i) {
    const FrameMotions a = kept.At(i), b = copy.At(i);
    EXPECT_EQ(b.frame, 2 * i);
    EXPECT_EQ(a.tracked, b.tracked);
    EXPECT_EQ(a.seen, b.seen);
    EXPECT_EQ(b.IndexOf(3), 1);
    EXPECT_EQ(a.motions[0].rotation, b.motions[0].rotation);
    EXPECT_EQ(a.motions[1].rotation, b.motions[1].rotation) << "a copy of it";
    const bool edited = i == 0 || i == 5 || i == 8;
    EXPECT_EQ(spooled.At(i).motions[1].rotation,
              edited ? Motion(i).rotation : Motion(0.2).rotation);
  }
}

TEST(FrameMotions, KnowOfWhichNodesTheyAre) {
  const MotionHistory history = SomeInUse();
  const FrameMotions last = history.At(2);
  EXPECT_EQ(last.IndexOf(1), -1);
  EXPECT_EQ(last.IndexOf(2), 0);
  EXPECT_EQ(last.IndexOf(3), -1);
  EXPECT_FALSE(last.Saw(0));
  EXPECT_TRUE(last.Saw(2));
  EXPECT_EQ(last.Of(2).translation, Motion(0.6).translation);
  EXPECT_EQ(history.At(1).IndexOf(2), 2);
  EXPECT_EQ(history.At(1).IndexOf(3), -1);
  const FrameMotions apart = {
      0, true, {Motion(1), Motion(2)}, {}, {{1, 2}, {4, 5}}};
  EXPECT_EQ(apart.IndexOf(4), 1);
  EXPECT_EQ(apart.IndexOf(3), -1);
  std::vector<NodeMotion> all(5);
  apart.SpreadTo(&all);
  EXPECT_TRUE(all[0].rotation.isIdentity(0));
  EXPECT_EQ(all[1].rotation, Motion(1).rotation);
  EXPECT_TRUE(all[2].rotation.isIdentity(0));
  EXPECT_EQ(all[4].rotation, Motion(2).rotation);
}

TEST(MotionsOfAll, AreTheNearestOfNodesThatAreNotInUse) {
  DeformationGraph graph;
  graph.positions.resize(3);
  graph.parts = {{0, 3, 5}, {2, 4}};
  const auto turned_by = [&](int frame, int node) {
    const MotionHistory history = SomeInUse();
    return MotionsOfAll(history, graph, EndsOfParts(history, graph),
                        frame)[node]
        .rotation;
  };
  EXPECT_EQ(turned_by(3, 1), Motion(0.2).rotation);
  EXPECT_EQ(turned_by(3, 2), Motion(0.5).rotation) << "of frame 4";
  EXPECT_EQ(turned_by(4, 2), Motion(0.5).rotation);
  EXPECT_EQ(turned_by(5, 2), Motion(0.6).rotation);
  EXPECT_EQ(turned_by(5, 0), Motion(0.3).rotation) << "of frame 4";
  EXPECT_EQ(turned_by(5, 1), Motion(0.4).rotation);
}

}  // namespace
}  // namespace splitfusion
