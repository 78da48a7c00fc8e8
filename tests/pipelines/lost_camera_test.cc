// Recordings that are cut, go black, jump, and show something else for a while.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "splitfusion/lib/evaluation/trajectory_error.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"
#include "splitfusion/pipelines/split_fusion.h"

namespace splitfusion {
namespace {

/// What a frame of a cut recording shows.
enum class Shot { kRoom, kBlack, kOther };

struct Cut {
  Shot shot = Shot::kRoom;
  int frame = 0;  ///< Of the scene.
};

SyntheticOptions SceneOptions(SyntheticSceneKind scene) {
  SyntheticOptions options;
  options.scene = scene;
  options.width = 320, options.height = 240;
  options.frames = 120;
  return options;
}

/// A recording in pieces, and how it was followed.
class CutRecording {
 public:
  CutRecording()
      : fusion_(room_.camera(), PipelineOptions(), LabelTable(), nullptr) {}

  /// Shows frames `from` to `to` - 1 of a scene, backward if `to` is smaller.
  void Show(Shot shot, int from, int to) {
    const int step = from < to ? 1 : -1;
    for (int frame = from; frame != to; frame += step) Show({shot, frame});
  }

  const SplitFusion& fusion() const { return fusion_; }
  SplitFusion& fusion() { return fusion_; }
  const Trajectory& truth() const { return truth_; }
  const std::vector<TrackState>& states() const { return states_; }
  const std::vector<std::string>& events() const { return events_; }

  /// Root mean square error of the poses of frames of the room.
  double Error() const {
    Trajectory found, truth;
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      if (shots_[i] != Shot::kRoom) continue;
      found.push_back(fusion_.trajectory()[i]);
      truth.push_back(truth_[i]);
    }
    return CompareTrajectories(found, truth).absolute.rmse;
  }

 private:
  void Show(const Cut& cut) {
    const bool other = cut.shot == Shot::kOther;
    Frame frame = (other ? other_ : room_).Render(cut.frame).frame;
    frame.index = static_cast<int>(truth_.size());
    frame.timestamp = 1000 + frame.index / 30.0;
    frame.world_from_camera.reset();
    if (cut.shot == Shot::kBlack) {
      frame.color.setTo(0);
      frame.depth.setTo(0);
    }
    truth_.push_back({frame.timestamp, room_.WorldFromCamera(cut.frame)});
    shots_.push_back(cut.shot);
    const FrameReport report = fusion_.ProcessFrame(frame);
    states_.push_back(report.surfaces.at(0).state);
    events_.push_back(report.surfaces.at(0).event);
  }

  SyntheticScene room_{SceneOptions(SyntheticSceneKind::kRoom)};
  SyntheticScene other_{SceneOptions(SyntheticSceneKind::kPerson)};
  SplitFusion fusion_;
  Trajectory truth_;
  std::vector<Shot> shots_;
  std::vector<TrackState> states_;
  std::vector<std::string> events_;
};

int Lost(const std::vector<TrackState>& states, int from, int to) {
  return static_cast<int>(std::count(states.begin() + from, states.begin() + to,
                                     TrackState::kLost));
}

TEST(LostCamera, IsFoundAfterJumpsAndCutsAndNothingIsFusedBetween) {
  CutRecording cut;
  cut.Show(Shot::kRoom, 0, 60);
  cut.Show(Shot::kRoom, 5, 25);    // A jump to another place.
  cut.Show(Shot::kBlack, 25, 35);  // The camera goes on unseen.
  cut.Show(Shot::kRoom, 35, 45);
  cut.Show(Shot::kOther, 0, 10);  // Another scene.
  cut.Show(Shot::kRoom, 70, 50);  // And a place near one that is known.
  const std::vector<TrackState>& states = cut.states();
  EXPECT_EQ(Lost(states, 0, 60), 0);
  EXPECT_LE(Lost(states, 60, 65), 4);
  EXPECT_EQ(Lost(states, 65, 80), 0);
  EXPECT_EQ(Lost(states, 80, 90), 10);
  EXPECT_LE(Lost(states, 90, 95), 4);
  EXPECT_EQ(Lost(states, 95, 100), 0);
  EXPECT_EQ(Lost(states, 100, 110), 10);
  EXPECT_LE(Lost(states, 110, 115), 4);
  EXPECT_EQ(Lost(states, 115, 130), 0);
  EXPECT_LT(cut.Error(), 0.005);
}

TEST(LostCamera, GoesSmoothlyFromLastSeenToNextSeen) {
  CutRecording cut;
  cut.Show(Shot::kRoom, 0, 20);
  cut.Show(Shot::kBlack, 20, 28);
  cut.Show(Shot::kRoom, 28, 40);
  cut.Show(Shot::kBlack, 40, 43);  // Nothing comes after.
  cut.fusion().PlaceLostCamera();
  const Trajectory& found = cut.fusion().trajectory();
  const Rigid3d world = cut.truth().front().world_from_camera;
  for (int i = 20; i < 28; ++i) {
    const Rigid3d off = found[i].world_from_camera.inverse() * world.inverse() *
                        cut.truth()[i].world_from_camera;
    EXPECT_LT(off.translation().norm(), 0.02) << i;
  }
  EXPECT_TRUE(
      found[42].world_from_camera.isApprox(found[39].world_from_camera));
  // The history of the background says the same.
  const MotionLog& history = cut.fusion().surfaces().at(0)->history();
  for (const int i : {0, 24, 42}) {
    const NodeMotion& motion = history.Find(i)->motions.at(0);
    const Rigid3d pose = found[i].world_from_camera.inverse();
    EXPECT_LT((motion.translation - pose.translation()).norm(), 1e-9) << i;
  }
}

}  // namespace
}  // namespace splitfusion
