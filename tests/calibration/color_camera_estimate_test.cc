#include "splitfusion/lib/calibration/color_camera_estimate.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/shared_data.h"
#include "support/two_cameras.h"

namespace splitfusion {
namespace {

std::vector<Frame> Boards(const ColorCamera& color_camera, int count) {
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(BoardsFrame(i, BoardsCamera(), color_camera));
  }
  return frames;
}

Eigen::Vector2d PixelOf(const ColorCamera& camera,
                        const Eigen::Vector3d& point) {
  const Eigen::Vector3d p = camera.color_from_depth * point;
  return {camera.fx * p.x() / p.z() + camera.cx,
          camera.fy * p.y() / p.z() + camera.cy};
}

TEST(ColorCameraEstimate, FindsTheCameraOfAKinectThatIsNotRegistered) {
  const ColorCamera truth = BoardsColorCamera();
  const ColorCameraEstimate estimate =
      EstimateColorCamera(Boards(truth, 8), BoardsCamera());
  EXPECT_EQ(estimate.frames, 8);
  EXPECT_TRUE(estimate.IsNeeded()) << estimate.Text();
  // What counts is where things are seen: turning and shifting a camera are
  // nearly the same.
  for (const double z : {0.8, 1.2, 2.0}) {
    for (const double x : {-0.35, 0.0, 0.35}) {
      for (const double y : {-0.25, 0.0, 0.25}) {
        const Eigen::Vector3d point(x * z, y * z, z);
        EXPECT_LT(
            (PixelOf(estimate.camera, point) - PixelOf(truth, point)).norm(),
            1.0)
            << point.transpose();
      }
    }
  }
}

// Edges fit halfway at many wrong places, and more so where frames show the
// same: the colour camera of both recordings has a focal length of 525 pixels.
TEST(ColorCameraEstimate, IsThatOfTheWholeRecordingOnEveryStretch) {
  for (const char* name : {"7scenes_redkitchen", "7scenes_redkitchen_b"}) {
    const std::string sequence = SharedData(name);
    SKIP_WITHOUT_SHARED_DATA(sequence, name);
    for (const int first : {0, 40}) {
      ReaderOptions options;
      options.first_frame = first;
      options.max_frames = 20;
      const ColorCameraEstimate estimate =
          EstimateColorCamera(ImageFolderReader(sequence, options));
      EXPECT_TRUE(estimate.IsNeeded()) << estimate.Text();
      EXPECT_NEAR(estimate.camera.fx, 525, 5) << estimate.Text();
      EXPECT_NEAR(estimate.camera.color_from_depth.translation().x(), -0.02,
                  0.01)
          << estimate.Text();
    }
  }
}

TEST(ColorCameraEstimate, LeavesRegisteredImagesAlone) {
  const ColorCamera registered = ColorCamera::Registered(BoardsCamera());
  const ColorCameraEstimate estimate =
      EstimateColorCamera(Boards(registered, 8), BoardsCamera());
  EXPECT_FALSE(estimate.IsNeeded()) << estimate.Text();
  EXPECT_LT(estimate.shift, 1.0);
}

// Something always fits a little better: in a camera that stands, in one frame
// that comes again and again, and where colour is late in a short turn.
TEST(ColorCameraEstimate, LeavesRecordingsThatAreRegisteredAlone) {
  for (const char* name : {"tum_fr1_rpy_a", "tum_fr1_rpy", "snoopy"}) {
    const std::string sequence = SharedData(name);
    SKIP_WITHOUT_SHARED_DATA(sequence, name);
    for (const int count : {2, 12, 24}) {
      ReaderOptions options;
      options.max_frames = count;
      const ColorCameraEstimate estimate =
          EstimateColorCamera(ImageFolderReader(sequence, options));
      EXPECT_FALSE(estimate.IsNeeded()) << name << ": " << estimate.Text();
    }
    const ImageFolderReader reader(sequence);
    for (const int i : {0, 30}) {
      const std::vector<Frame> still(3, reader.Read(i));
      const ColorCameraEstimate estimate =
          EstimateColorCamera(still, reader.camera());
      EXPECT_FALSE(estimate.IsNeeded()) << name << ": " << estimate.Text();
    }
  }
}

TEST(ColorCameraEstimate, SaysNothingOfImagesWithoutEdges) {
  Frame flat = BoardsFrame(0, BoardsCamera(), BoardsColorCamera());
  flat.depth.setTo(2);
  const ColorCameraEstimate estimate =
      EstimateColorCamera({flat, flat, flat}, BoardsCamera());
  EXPECT_EQ(estimate.frames, 0);
  EXPECT_FALSE(estimate.IsNeeded());
}

TEST(ColorCameraEstimate, IsTheSameEveryTime) {
  const std::vector<Frame> frames = Boards(BoardsColorCamera(), 4);
  EXPECT_EQ(ToText(EstimateColorCamera(frames, BoardsCamera()).camera),
            ToText(EstimateColorCamera(frames, BoardsCamera()).camera));
}

}  // namespace
}  // namespace splitfusion
