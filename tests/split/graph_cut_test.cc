#include "splitfusion/lib/split/graph_cut.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "split/layered_scene.h"
#include "splitfusion/lib/split/surface_prior.h"
#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

const cv::Rect kCard(50, 30, 50, 60);

/// Cuts with a mask and no prediction; result of frame size.
cv::Mat_<uchar> CutByMask(const Frame& frame, const cv::Mat_<uchar>& mask) {
  const SplitOptions options = SceneOptions();
  const PointMap points = ComputePointMap(frame.depth, SceneCamera());
  const cv::Mat_<uchar> unknown(frame.depth.size(), uchar(0));
  const ComparedDepth nothing{LabelImage(frame.depth.size(), 0), unknown,
                              unknown};
  const SurfaceEvidence evidence = GatherEvidence(
      {0, mask, {}, {}}, nothing, options.graph_cut, options.prior);
  cv::Mat_<uchar> result(frame.depth.size(), uchar(0));
  CutForeground(points, frame.color, evidence.crop, evidence.evidence,
                options.graph_cut)
      .copyTo(result(evidence.crop));
  return result;
}

TEST(GraphCut, RepairsAMaskBetweenTwoPlanes) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  const Frame frame = scene.MakeFrame(0);
  const cv::Mat_<uchar> truth = scene.Truth(1);
  cv::Mat_<uchar> eroded, dilated;
  const cv::Mat kernel = cv::Mat::ones(9, 9, CV_8U);
  cv::erode(truth, eroded, kernel);
  cv::dilate(truth, dilated, kernel);
  cv::Mat_<uchar> holed = truth.clone();
  holed(cv::Rect(60, 40, 12, 12)) = 0;
  for (const cv::Mat_<uchar>& mask :
       {truth, eroded, dilated, holed, Moved(truth, 4, 2),
        Moved(eroded, -2, 0)}) {
    EXPECT_GT(Iou(CutByMask(frame, mask), truth), 0.98) << Iou(mask, truth);
  }
}

TEST(GraphCut, DropsABlobOfTheMaskOnTheWall) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  cv::Mat_<uchar> mask = scene.Truth(1);
  cv::circle(mask, {110, 40}, 14, cv::Scalar(255), -1);
  const Frame frame = scene.MakeFrame(0);
  EXPECT_GT(Iou(CutByMask(frame, mask), scene.Truth(1)), 0.97);
}

TEST(GraphCut, CutsAlongACreaseWhereSurfacesTouch) {
  // A box face at 2 m whose lower edge stands on a floor that comes nearer.
  LayeredScene scene;
  scene.Add({0, 0, 160, 80}, 2.0, 1);
  Frame frame = scene.MakeFrame(0);
  const PinholeCamera camera = SceneCamera();
  const double floor_height = 20 / camera.fy * 2.0;  // Below the axis, metres.
  for (int v = 80; v < 120; ++v) {
    frame.depth.row(v) = camera.fy * floor_height / (v - camera.cy);
  }
  frame.color = cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(90));
  const cv::Mat_<uchar> truth = RectMask({40, 20, 80, 60});
  const cv::Mat_<uchar> cut = CutByMask(frame, RectMask({40, 20, 80, 64}));
  const cv::Rect below(50, 84, 60, 20);
  EXPECT_LT(cv::countNonZero(cut(below)), 0.05 * below.area());
  EXPECT_GT(cv::countNonZero(cut(cv::Rect(50, 30, 60, 46))), 0.99 * 60 * 46);
}

TEST(GraphCut, LeavesPixelsWithoutDepthOut) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  Frame frame = scene.MakeFrame(0);
  const cv::Rect hole(60, 50, 20, 10);
  frame.depth(hole) = 0.0;
  const cv::Mat_<uchar> cut = CutByMask(frame, scene.Truth(1));
  EXPECT_EQ(cv::countNonZero(cut(hole)), 0);
  cv::Mat_<uchar> expected = scene.Truth(1);
  expected(hole) = 0;
  EXPECT_GT(Iou(cut, expected), 0.99);
}

TEST(GraphCut, WithoutEvidenceEverythingIsBackground) {
  LayeredScene scene;
  const Frame frame = scene.MakeFrame(0);
  const PointMap points = ComputePointMap(frame.depth, SceneCamera());
  const cv::Rect crop(10, 10, 30, 20);
  const cv::Mat_<float> none(crop.size(), 0.0f);
  EXPECT_EQ(cv::countNonZero(CutForeground(points, frame.color, crop, none,
                                           GraphCutOptions())),
            0);
  const cv::Mat_<float> all(crop.size(), 1.0f);
  EXPECT_EQ(cv::countNonZero(CutForeground(points, frame.color, crop, all,
                                           GraphCutOptions())),
            crop.area());
  const cv::Mat_<float> certain(crop.size(), kSurelyBackground);
  EXPECT_EQ(cv::countNonZero(CutForeground(points, frame.color, crop, certain,
                                           GraphCutOptions())),
            0);
}

TEST(GraphCut, NamesBadOptionsAndSizes) {
  GraphCutOptions options;
  options.core_erosion = 0;
  ExpectInputError([&] { CheckOptions(options); },
                   "core_erosion = 0: expected 1..100 pixels");
  options = {};
  options.color_share = 2;
  ExpectInputError([&] { CheckOptions(options); }, "color_share = 2");
  const cv::Mat_<float> small(3, 3, 0.0f);
  ExpectInputError(
      [&] {
        CutForeground({}, {}, cv::Rect(0, 0, 4, 5), small, GraphCutOptions());
      },
      "3x3: expected the size 4x5");
}

}  // namespace
}  // namespace splitfusion
