// Masks that are wrong in the ways of detectors, refined on a scene of which
// the truth is known.

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/imgproc.hpp>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/surface_splitter.h"
#include "splitfusion/lib/synthetic/detections.h"
#include "splitfusion/lib/synthetic/synthetic_scene.h"

namespace splitfusion {
namespace {

using Fault = std::function<cv::Mat_<uchar>(const cv::Mat_<uchar>&)>;

cv::Mat Disk(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE,
                                   cv::Size(2 * radius + 1, 2 * radius + 1));
}

cv::Mat_<uchar> Eroded(const cv::Mat_<uchar>& mask) {
  cv::Mat_<uchar> result;
  cv::erode(mask, result, Disk(4));
  return result;
}

cv::Mat_<uchar> Dilated(const cv::Mat_<uchar>& mask) {
  cv::Mat_<uchar> result;
  cv::dilate(mask, result, Disk(4));
  return result;
}

cv::Mat_<uchar> Wobbly(const cv::Mat_<uchar>& mask) {
  DetectorFaults faults = ExactDetector();
  faults.border_px = 5;
  return ImitateDetections(mask / 255, {{1, "person"}}, faults, 7).at(0).mask;
}

cv::Mat_<uchar> ShiftedBy2(const cv::Mat_<uchar>& mask) {
  return Moved(mask, 2, -2);
}

/// Five holes of 25 pixels along the vertical axis.
cv::Mat_<uchar> Holed(const cv::Mat_<uchar>& mask) {
  cv::Mat_<uchar> result = mask.clone();
  const cv::Rect box = cv::boundingRect(mask);
  for (int i = 1; i <= 5; ++i) {
    const cv::Point at(box.x + box.width / 2, box.y + i * box.height / 6);
    cv::circle(result, at, 12, cv::Scalar(0), -1);
  }
  return result;
}

/// The synthetic room with its person, 640x480, with Kinect noise.
class RefinementTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    SyntheticOptions options;
    options.frames = 20;
    const SyntheticScene scene(options);
    camera_ = scene.camera();
    for (int i = 0; i < 3; ++i) frames_[i] = scene.Render(6 * i);
  }
  /// Refines a faulty mask of the person in three frames; expects an IoU of at
  /// least `bound`, and of about what it was, over pixels with depth.
  static void ExpectRepaired(const Fault& fault, double bound) {
    SurfaceSplitter splitter(camera_, LabelTable(), SplitOptions());
    for (const SyntheticFrame& frame : frames_) {
      const cv::Mat measured = frame.frame.depth > 0;
      const cv::Mat_<uchar> truth = frame.labels == kPersonId;
      const cv::Mat_<uchar> mask = fault(truth);
      const SplitResult result = splitter.Split(
          frame.frame, ComputePointMap(frame.frame.depth, camera_),
          {{mask, "person", 0.9}}, {});
      const double before = Iou(mask & measured, truth & measured);
      const double after =
          Iou((result.labels == 1) & measured, truth & measured);
      EXPECT_GE(after, before - 0.005) << "frame " << frame.frame.index;
      EXPECT_GE(after, bound)
          << "frame " << frame.frame.index << ", before " << before;
    }
  }
  static PinholeCamera camera_;
  static SyntheticFrame frames_[3];
};

PinholeCamera RefinementTest::camera_;
SyntheticFrame RefinementTest::frames_[3];

TEST_F(RefinementTest, RepairsMasksThatAreErodedBy4Pixels) {
  ExpectRepaired(Eroded, 0.975);
}

TEST_F(RefinementTest, RepairsMasksThatAreDilatedBy4Pixels) {
  ExpectRepaired(Dilated, 0.96);
}

TEST_F(RefinementTest, RepairsMasksWithAWobblyBorder) {
  ExpectRepaired(Wobbly, 0.96);
}

TEST_F(RefinementTest, RepairsMasksThatAreShiftedBy2Pixels) {
  ExpectRepaired(ShiftedBy2, 0.975);
}

TEST_F(RefinementTest, ClosesHolesOfMasks) { ExpectRepaired(Holed, 0.98); }

TEST_F(RefinementTest, RepairsAllOfItAtOnce) {
  ExpectRepaired(
      [](const cv::Mat_<uchar>& mask) {
        return Holed(ShiftedBy2(Wobbly(mask)));
      },
      0.96);
}

TEST_F(RefinementTest, LeavesExactMasksNearlyAsTheyAre) {
  const auto exact = [](const cv::Mat_<uchar>& mask) { return mask.clone(); };
  SurfaceSplitter splitter(camera_, LabelTable(), SplitOptions());
  for (const SyntheticFrame& frame : frames_) {
    const cv::Mat measured = frame.frame.depth > 0;
    const cv::Mat_<uchar> truth = frame.labels == kPersonId;
    const SplitResult result =
        splitter.Split(frame.frame, ComputePointMap(frame.frame.depth, camera_),
                       {{exact(truth), "person", 0.9}}, {});
    EXPECT_GE(Iou((result.labels == 1) & measured, truth & measured), 0.97);
  }
}

}  // namespace
}  // namespace splitfusion
