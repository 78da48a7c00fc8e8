#include "splitfusion/lib/report/run_summary.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "splitfusion/lib/base/archive.h"
#include "support/sample_report.h"

namespace splitfusion {
namespace {

TEST(SummaryBuilder, CountsTimesOverFrames) {
  SummaryBuilder builder;
  for (const double seconds : {1.0, 2.0, 9.0}) {
    FrameReport report = SampleReport(0);
    report.total_seconds = seconds;
    report.fuse_seconds = seconds / 10;
    builder.Add(report);
  }
  const auto json = ToJson(builder.Build());
  EXPECT_EQ(json["frames"], 3);
  EXPECT_EQ(json["seconds_per_frame"]["median"], 2.0);
  EXPECT_EQ(json["seconds_per_frame"]["mean"], 4.0);
  EXPECT_DOUBLE_EQ(json["seconds_per_frame"]["parts"]["fuse"], 0.4);
  EXPECT_DOUBLE_EQ(json["seconds_per_frame"]["parts"]["solve"], 0.2);
}

/// Makes it a state or an event of this name.
void Be(const std::string& word, SurfaceReport* surface) {
  for (const TrackState state :
       {TrackState::kOccluded, TrackState::kLost, TrackState::kInactive}) {
    if (ToString(state) == word) surface->state = state;
  }
  if (word == "born" || word == "reanchored") surface->event = word;
}

TEST(SummaryBuilder, FollowsSurfacesFromBirthThroughLoss) {
  SummaryBuilder builder;
  for (int frame = 0; frame < 5; ++frame) {
    FrameReport report = SampleReport(frame);
    SurfaceReport& person = report.surfaces[1];
    if (frame == 1) person.event = "born";
    if (frame == 3) person.state = TrackState::kLost;
    if (frame == 4) person.state = TrackState::kOccluded;
    person.vertices = 100 * frame;
    if (frame == 0) report.surfaces.pop_back();
    builder.Add(report);
  }
  const RunSummary summary = builder.Build();
  EXPECT_EQ(summary.lost_frames, 1);
  ASSERT_EQ(summary.surfaces.size(), 2u);
  EXPECT_EQ(summary.surfaces[0].frames, 5);
  const SurfaceSummary& person = summary.surfaces[1];
  EXPECT_EQ(person.first_frame, 1);
  EXPECT_EQ(person.frames, 2);
  EXPECT_EQ(person.vertices, 400);
  EXPECT_EQ(person.lost, std::vector<int>{3});
  EXPECT_EQ(person.occluded, std::vector<int>{4});
}

TEST(SummaryBuilder, GoesOnFromItsState) {
  const std::vector<std::string> states = {"born",     "tracked", "lost",
                                           "occluded", "tracked", "occluded"};
  for (std::size_t saved = 0; saved < states.size(); ++saved) {
    SummaryBuilder whole, begun, resumed;
    for (std::size_t frame = 0; frame < states.size(); ++frame) {
      FrameReport report = SampleReport(static_cast<int>(frame));
      report.total_seconds = 0.1 * static_cast<double>(frame);
      Be(states[frame], &report.surfaces[1]);
      whole.Add(report);
      (frame <= saved ? begun : resumed).Add(report);
      if (frame != saved) continue;
      std::stringstream stream;
      ArchiveWriter writer(&stream);
      writer(begun);
      writer.Flush();
      ArchiveReader reader(&stream, stream.str().size(), "state");
      reader(resumed);
    }
    EXPECT_EQ(ToJson(resumed.Build()), ToJson(whole.Build())) << saved;
  }
}

/// A run whose person goes through these states.
RunSummary Through(const std::vector<std::string>& states) {
  SummaryBuilder builder;
  for (std::size_t frame = 0; frame < states.size(); ++frame) {
    FrameReport report = SampleReport(static_cast<int>(frame));
    report.surfaces[1].label = "person";
    Be(states[frame], &report.surfaces[1]);
    builder.Add(report);
  }
  return builder.Build();
}

TEST(SummaryBuilder, CountsWhoWasLostOccludedAndFoundAgain) {
  const RunSummary summary =
      Through({"born", "tracked", "occluded", "occluded", "tracked", "lost",
               "tracked", "inactive", "tracked"});
  EXPECT_EQ(summary.lost_frames, 1);
  EXPECT_EQ(summary.occluded_frames, 2);
  EXPECT_EQ(summary.refound_frames, 3);
  EXPECT_EQ(summary.surfaces[1].refound, (std::vector<int>{4, 6, 8}));
  EXPECT_EQ(summary.surfaces[1].away_since, -1);
  const auto json = ToJson(summary)["surfaces"][1];
  EXPECT_EQ(json["lost_frames"], 1);
  EXPECT_EQ(json["occluded_frames"], 2);
  EXPECT_EQ(json["refound_frames"], 3);
  EXPECT_TRUE(json["away_since"].is_null());
}

TEST(HoldLines, SayWhatNoDataHoldInTheLastFrameThatTells) {
  SummaryBuilder builder;
  for (int frame = 0; frame < 4; ++frame) {
    FrameReport report = SampleReport(frame);
    // Every other frame tells.
    if (frame % 2 == 0) report.surfaces[1].hold = {310, 15 + frame, 0.001};
    builder.Add(report);
  }
  RunSummary summary = builder.Build();
  const SurfaceSummary& person = summary.surfaces[1];
  EXPECT_EQ(HoldLines(summary),
            std::vector<std::string>{
                "17 of 310 nodes of surface " + std::to_string(person.id) +
                " (" + person.label + ") are held by the prior alone"});
  const auto json = ToJson(summary);
  EXPECT_EQ(json["surfaces"][1]["hold"]["held_by_prior"], 17);
  EXPECT_FALSE(json["surfaces"][0].contains("hold"));
  summary.surfaces[1].hold->held_by_prior = 0;
  EXPECT_TRUE(HoldLines(summary).empty());
}

TEST(VerdictLine, SaysWhoWasNotFoundAgain) {
  EXPECT_EQ(VerdictLine(Through({"born", "tracked"})),
            "2 frames, 2 surfaces, none lost or occluded");
  EXPECT_EQ(VerdictLine(Through({"born", "lost", "tracked"})),
            "3 frames, 2 surfaces; 1 person lost in 1 frame, found again");
  RunSummary summary =
      Through({"born", "tracked", "occluded", "lost", "occluded", "inactive"});
  EXPECT_EQ(summary.surfaces[1].away_since, 2);
  EXPECT_EQ(VerdictLine(summary),
            "6 frames, 2 surfaces; 1 person lost in 1 frame, occluded in 2 "
            "frames, not found again since frame 2");
  summary.complete = false;
  EXPECT_EQ(VerdictLine(summary).rfind("incomplete: ", 0), 0u);
  EXPECT_EQ(ToJson(summary)["verdict"], VerdictLine(summary));
}

TEST(SummaryBuilder, AReanchoredSurfaceIsFoundAgain) {
  const RunSummary summary =
      Through({"born", "tracked", "lost", "lost", "reanchored", "tracked"});
  EXPECT_EQ(summary.surfaces[1].reanchored, std::vector<int>{4});
  EXPECT_EQ(summary.surfaces[1].refound, std::vector<int>{4});
  EXPECT_EQ(summary.surfaces[1].lost, (std::vector<int>{2, 3}));
  EXPECT_EQ(summary.surfaces[1].frames, 4);
  EXPECT_EQ(summary.surfaces[1].away_since, -1);
}

TEST(SummaryBuilder, TakesTheSpacingOfTheLastGraph) {
  SummaryBuilder builder;
  for (const double spacing : {0.04, 0.05}) {
    FrameReport report = SampleReport(0);
    report.surfaces[1].node_spacing = spacing;
    builder.Add(report);
  }
  FrameReport dropped = SampleReport(2);
  dropped.surfaces[1].nodes = 0;
  dropped.surfaces[1].node_spacing = 0;
  builder.Add(dropped);
  const auto json = ToJson(builder.Build());
  EXPECT_EQ(json["surfaces"][0]["node_spacing"], 0.0);  // Rigid.
  EXPECT_EQ(json["surfaces"][1]["node_spacing"], 0.05);
}

TEST(SummaryBuilder, TakesTheSizesThatWereWritten) {
  SummaryBuilder builder;
  builder.Add(SampleReport(0));
  StretchedArea stretch;
  stretch.area = 4;
  stretch.stretched = 1;
  builder.SetWritten(1, {77, 12345, stretch});
  builder.SetWritten(9, {1, 1, stretch});  // Never reported.
  const RunSummary summary = builder.Build();
  ASSERT_EQ(summary.surfaces.size(), 2u);
  EXPECT_EQ(summary.surfaces[1].nodes, 77);
  EXPECT_EQ(summary.surfaces[1].vertices, 12345);
  const auto surfaces = ToJson(summary)["surfaces"];
  EXPECT_EQ(surfaces[1]["stretched"], 0.25);
  EXPECT_FALSE(surfaces[0].contains("stretched"));  // No warped meshes.
}

TEST(SummaryBuilder, IsFiniteWithoutFrames) {
  const auto json = ToJson(SummaryBuilder().Build());
  EXPECT_EQ(json["frames"], 0);
  EXPECT_EQ(json["seconds_per_frame"]["mean"], 0.0);
  EXPECT_TRUE(json["surfaces"].is_array());
}

}  // namespace
}  // namespace splitfusion
