#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "splitfusion/lib/sequence/tum_writer.h"
#include "splitfusion/pipelines/reconstruction.h"
#include "support/rolling_room.h"
#include "support/temporary_folder.h"

namespace splitfusion {
namespace {

/// Mean distance of the camera from where it was with the middle rows, metres.
double TrackingError(const RollingRoom& room, double rolling_shutter) {
  constexpr int kFrames = 25;
  SplitFusion fusion(room.camera, PipelineOptions(), LabelTable(), nullptr);
  fusion.set_rolling_shutter(rolling_shutter);
  double sum = 0;
  for (int i = 0; i < kFrames; ++i) {
    fusion.ProcessFrame(room.At(i));
    const Rigid3d expected = RollingRoom::PoseAt(0).inverse() *
                             RollingRoom::PoseAt(RollingRoom::kInterval * i);
    sum += (fusion.trajectory().back().world_from_camera.translation() -
            expected.translation())
               .norm();
  }
  return sum / kFrames;
}

TEST(RollingShutterRun, TheCameraIsWhereItWasWithTheMiddleRow) {
  const double undone = TrackingError({0.025}, 0.025);
  EXPECT_LT(undone, 0.5 * TrackingError({0.025}, 0));
  EXPECT_LT(undone, 0.01);
}

/// Says of all pixels what one mask says.
class MaskOfAll : public Segmenter {
 public:
  explicit MaskOfAll(const std::string& class_name) : class_(class_name) {}

  std::vector<InstanceMask> Segment(const Frame& frame) override {
    return {{cv::Mat(frame.depth.size(), CV_8UC1, cv::Scalar(255)), class_}};
  }

 private:
  std::string class_;
};

/// What a reconstruction says of the rows of a sequence.
std::string RowsNote(const std::string& sequence,
                     const std::shared_ptr<Segmenter>& segmenter) {
  const Reconstruction reconstruction(
      sequence, {}, PipelineOptions(), LabelTable(),
      [&](const ImageFolderReader&) { return segmenter; });
  EXPECT_EQ(reconstruction.fusion.rolling_shutter() > 0,
            !reconstruction.rows_note.empty());
  return reconstruction.rows_note;
}

TEST(RollingShutterRun, PeopleTellNothingOfHowRowsWereExposed) {
  const RollingRoom room{0.025};
  const TemporaryFolder folder;
  TumWriter writer(folder / "");
  for (int i = 0; i < 40; ++i) {
    const Frame frame = room.At(i);
    const std::string stem = std::to_string(1000 + i);
    writer.Add(stem, frame.timestamp, frame.color, frame.depth);
  }
  writer.Finish(room.camera, {});
  EXPECT_NE(RowsNote(folder / "", nullptr), "");
  EXPECT_EQ(RowsNote(folder / "", std::make_shared<MaskOfAll>("person")), "");
  EXPECT_NE(RowsNote(folder / "", std::make_shared<MaskOfAll>("chair")), "");
}

}  // namespace
}  // namespace splitfusion
