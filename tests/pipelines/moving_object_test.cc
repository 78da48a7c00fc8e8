// Rigid things in the synthetic room, start to end: one that begins to move,
// and a chair that does not.

#include <gtest/gtest.h>

#include "support/sample_depth.h"
#include "support/synthetic_run.h"

namespace splitfusion {
namespace {

constexpr int kStart = 8;  // Frame before the first motion.
constexpr int kStep = 3;   // Pixels a frame, to the right.
constexpr int kMovingFrames = 36;
const cv::Rect kBoard(100, 70, 60, 70);

/// Puts a plain board in front of everything, 2 m away, `shift` pixels to the
/// right of kBoard; with its detection. It gives the camera nothing to hold on
/// to that could drag it along.
void AddBoard(int shift, Frame* frame, std::vector<InstanceMask>* detections) {
  const cv::Rect at = kBoard + cv::Point(shift, 0);
  frame->depth(at) = 2.0;
  frame->color(at) = cv::Scalar(40, 90, 160);
  cv::Mat mask = cv::Mat::zeros(frame->depth.size(), CV_8UC1);
  mask(at) = 255;
  detections->push_back({mask, "suitcase", 0.9});
}

/// Puts a ball into the room whose middle is at `place` (camera frame, metres);
/// with its detection.
void AddBall(const Eigen::Vector3d& place, const PinholeCamera& camera,
             Frame* frame, std::vector<InstanceMask>* detections) {
  const cv::Mat_<float> ball = SphereDepth(camera, place, 0.25);
  const cv::Mat mask = ball > 0;
  ball.copyTo(frame->depth, mask);
  frame->color.setTo(cv::Scalar(40, 90, 160), mask);
  detections->push_back({mask, "sports ball", 0.9});
}

const Surface* FindSurface(const SplitFusion& fusion, const std::string& name) {
  for (const auto& [id, surface] : fusion.surfaces()) {
    if (surface->label() == name) return surface.get();
  }
  return nullptr;
}

SyntheticOptions EmptyRoom(double camera_motion) {
  SyntheticOptions options = SyntheticRun::Quick();
  options.scene = SyntheticSceneKind::kRoom;
  options.width = 320, options.height = 240;
  options.frames = kMovingFrames;
  options.camera_motion = camera_motion;
  return options;
}

TEST(MovingObject, BecomesARigidSurfaceThatIsTrackedWhenItMoves) {
  SyntheticRun run(EmptyRoom(/*camera_motion=*/0));
  int tracked = 0;
  for (int i = 0; i < kMovingFrames; ++i) {
    const int shift = kStep * std::max(0, i - kStart);
    const FrameReport report =
        run.Next([&](Frame* frame, std::vector<InstanceMask>* detections) {
          AddBoard(shift, frame, detections);
        });
    if (i <= kStart) {
      EXPECT_EQ(run.fusion().surfaces().size(), 1u) << i;
    }
    for (const SurfaceReport& surface : report.surfaces) {
      tracked += surface.id == 1 && surface.event.empty() &&
                 surface.state == TrackState::kTracked;
    }
  }
  const Surface* board = FindSurface(run.fusion(), "suitcase");
  ASSERT_NE(board, nullptr);
  EXPECT_EQ(run.fusion().surfaces().size(), 2u);
  EXPECT_EQ(board->kind(), SurfaceKind::kRigid);
  const int followed = kMovingFrames - 1 - board->first_frame();
  EXPECT_GE(followed, 5);
  EXPECT_EQ(tracked, followed);
  const cv::Rect at =
      kBoard + cv::Point(kStep * (kMovingFrames - 1 - kStart), 0);
  cv::Mat labels = run.fusion().labels().clone();
  EXPECT_GT(cv::countNonZero(labels(at) == 1), 0.97 * at.area());
  labels(at) = 0;
  EXPECT_LT(cv::countNonZero(labels), 0.03 * at.area());
}

TEST(MovingObject, IsForgottenByTheBackgroundAsItBeginsToMove) {
  SyntheticRun run(EmptyRoom(/*camera_motion=*/0));
  const Eigen::Vector3d place(0, 0, 1.5), step(0.002, 0, -0.003);
  for (int i = 0; i < kMovingFrames; ++i) {
    const int steps = std::max(0, i - kStart);
    run.Next([&](Frame* frame, std::vector<InstanceMask>* detections) {
      AddBall(place + steps * step, run.fusion().camera(), frame, detections);
    });
  }
  const Surface* ball = FindSurface(run.fusion(), "sports ball");
  ASSERT_NE(ball, nullptr);
  EXPECT_GT(ball->first_frame(), kStart);
  EXPECT_LT(ball->first_frame(), kStart + 8);
  EXPECT_EQ(run.fusion().surfaces().size(), 2u);
  run.fusion().Finish();
  int left = 0;
  for (const auto& v : run.fusion().surfaces().at(0)->mesh().vertices) {
    left += (v.cast<double>() - place).norm() < 0.3;
  }
  EXPECT_EQ(left, 0);
}

TEST(MovingObject, AChairThatNobodyMovesStaysBackground) {
  SyntheticRun run(EmptyRoom(/*camera_motion=*/1));
  PipelineOptions options;
  options.own_motion_gain = 0;
  SyntheticRun unwatched(EmptyRoom(/*camera_motion=*/1), options);
  for (int i = 0; i < kMovingFrames; ++i) {
    for (const SplitDecision& decision : run.Next().decisions) {
      EXPECT_EQ(decision.class_name, "chair");
      EXPECT_EQ(decision.action, "ignored") << i;
    }
    unwatched.Next();
  }
  EXPECT_EQ(run.fusion().surfaces().size(), 1u);
  // What stands is tracked and mapped as if nobody had looked.
  EXPECT_TRUE(SameResults(run.fusion(), unwatched.fusion()));
}

}  // namespace
}  // namespace splitfusion
