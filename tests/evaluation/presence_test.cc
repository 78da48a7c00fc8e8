#include "splitfusion/lib/evaluation/presence.h"

#include <gtest/gtest.h>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

/// A person in plain view in ten frames, shown by surface 1 but in three.
std::vector<InstanceSighting> TenFrames() {
  std::vector<InstanceSighting> sightings;
  for (int frame = 0; frame < 10; ++frame) {
    const bool shown = frame < 4 || frame > 6;
    sightings.push_back({frame,
                         9000,
                         frame < kEntryFrames ? -1 : 9500,
                         {{1, shown ? 0.9 : 0.2}}});
  }
  return sightings;
}

TEST(JudgePresence, CountsTheFramesInWhichNobodyShowsAPerson) {
  const InstancePresence presence = JudgePresence(TenFrames());
  EXPECT_EQ(presence.surface_id, 1);
  EXPECT_EQ(presence.in_view.size(), 10u);
  EXPECT_EQ(presence.missing, (std::vector<int>{4, 5, 6}));
  EXPECT_DOUBLE_EQ(presence.MissingShare(), 0.3);
  EXPECT_TRUE(presence.InView(5) && presence.Missing(5));
  EXPECT_TRUE(presence.InView(7));
  EXPECT_FALSE(presence.Missing(7));
}

TEST(JudgePresence, AnotherSurfaceIsNotTheOne) {
  auto sightings = TenFrames();
  for (const int frame : {4, 5, 6}) sightings[frame].shares[2] = 1;
  EXPECT_EQ(JudgePresence(sightings).missing, (std::vector<int>{4, 5, 6}));
}

TEST(JudgePresence, FramesWithFewPixelsDoNotCount) {
  auto sightings = TenFrames();
  sightings[5].live_pixels = 8000;  // No more than the limit.
  const InstancePresence presence = JudgePresence(sightings);
  EXPECT_EQ(presence.in_view.size(), 9u);
  EXPECT_EQ(presence.missing, (std::vector<int>{4, 6}));
}

TEST(JudgePresence, WhoJustCameIntoViewIsWaitedFor) {
  auto sightings = TenFrames();
  sightings[4].earlier_pixels = 3000;
  EXPECT_EQ(JudgePresence(sightings).missing, (std::vector<int>{5, 6}));
}

TEST(JudgePresence, FramesBeforeTheSurfaceDoNotCountForAWhile) {
  std::vector<InstanceSighting> sightings;
  for (int frame = 10; frame < 40; ++frame) {
    sightings.push_back({frame, 9000, -1, {}});
    if (frame >= 12) sightings.back().shares[3] = 0.8;
  }
  EXPECT_EQ(JudgePresence(sightings).in_view.front(), 12);
  for (auto& sighting : sightings) {
    if (sighting.frame < 35) sighting.shares.clear();
  }
  const InstancePresence late = JudgePresence(sightings);
  EXPECT_EQ(late.in_view.front(), 10 + kPatienceFrames);
  EXPECT_EQ(late.missing.size(), 10u);  // 25 to 34.
}

TEST(JudgePresence, WhoIsNeverShownIsMissingFromTheStart) {
  auto sightings = TenFrames();
  for (auto& sighting : sightings) sighting.shares.clear();
  const InstancePresence presence = JudgePresence(sightings);
  EXPECT_EQ(presence.surface_id, -1);
  EXPECT_EQ(presence.missing.size(), 10u);
  EXPECT_TRUE(JudgePresence({}).in_view.empty());
  EXPECT_EQ(JudgePresence({}).MissingShare(), 0);
}

TEST(PresenceOptions, RejectsNonsense) {
  PresenceOptions options;
  options.plain_view_pixels = -1;
  EXPECT_THROW(options.Check(), InputError);
  options = {};
  options.shown_share = 0;
  EXPECT_THROW(options.Check(), InputError);
}

}  // namespace
}  // namespace splitfusion
