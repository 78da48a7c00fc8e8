#include "splitfusion/lib/synthetic/synthetic_options.h"

#include <gtest/gtest.h>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

TEST(SyntheticSceneKind, EveryWordIsReadBack) {
  for (const std::string word :
       {"room_person", "room", "person", "soft_object"}) {
    EXPECT_EQ(ToString(ParseSyntheticSceneKind(word)), word);
  }
}

TEST(SyntheticSceneKind, UnknownWordListsTheKnownOnes) {
  ExpectInputError([] { ParseSyntheticSceneKind("moon"); },
                   "scene = moon: expected one of room_person, room, person, "
                   "soft_object");
}

TEST(SyntheticOptions, DefaultsAreGood) {
  EXPECT_NO_THROW(SyntheticOptions().Check());
}

TEST(SyntheticOptions, RejectsValuesOutOfRangeByName) {
  const auto message = [](auto change, const std::string& part) {
    SyntheticOptions options;
    change(&options);
    ExpectInputError([&] { options.Check(); }, part);
  };
  message([](auto* o) { o->frames = 0; }, "frames = 0: expected 1");
  message([](auto* o) { o->width = 10; }, "width = 10: expected 64");
  message([](auto* o) { o->height = 5000; }, "height = 5000: expected 48");
  message([](auto* o) { o->frame_rate = 0; }, "frame_rate = 0");
  message([](auto* o) { o->camera_motion = -1; }, "camera_motion = -1");
  message([](auto* o) { o->subject_speed = 9; }, "subject_speed = 9");
  message([](auto* o) { o->track_points = -5; }, "track_points = -5");
}

TEST(SyntheticCamera, FieldOfViewDoesNotDependOnTheResolution) {
  SyntheticOptions small, large;
  small.width = 160;
  small.height = 120;
  const PinholeCamera a = SyntheticCamera(small), b = SyntheticCamera(large);
  // The left image border, half a pixel left of the first centre.
  EXPECT_NEAR((-0.5 - a.cx) / a.fx, (-0.5 - b.cx) / b.fx, 1e-12);
  EXPECT_NEAR((119.5 - a.cy) / a.fy, (479.5 - b.cy) / b.fy, 1e-12);
  EXPECT_DOUBLE_EQ(b.fx, 535.4);
  EXPECT_DOUBLE_EQ(b.cx, 320.1);
}

}  // namespace
}  // namespace splitfusion
