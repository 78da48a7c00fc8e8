#include "splitfusion/lib/split/surface_splitter.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "split/splitter_fixture.h"
#include "splitfusion/lib/segmentation/mask_folder_segmenter.h"
#include "splitfusion/lib/sequence/image_folder_reader.h"
#include "support/expect_input_error.h"
#include "support/shared_data.h"

namespace splitfusion {
namespace {

const cv::Rect kCard(50, 25, 40, 70);
const cv::Rect kArm(90, 50, 45, 10);  // Touches the card.

class SurfaceSplitterTest : public SplitterTest {
 protected:
  /// Splits a frame with the card alone, then one in which it raises an arm,
  /// far outside of it and of every band around it, while a tracker predicts
  /// the card as it was before a known wall. Without a detection if `missed`,
  /// else with one that cuts the arm off. Returns the pixels of card and arm.
  cv::Mat_<uchar> RaiseArm(bool missed) {
    LayeredScene first, second;
    first.Add(kCard, 2.0, 1);
    second.Add(kCard, 2.0, 1).Add(kArm, 2.0, 1);
    const InstanceMask card{first.Truth(1), "person", 0.9};
    Split(first, {card});
    SurfacePrediction prediction{LabelImage(120, 160, std::uint16_t(0)),
                                 first.depth().clone(),
                                 cv::Mat_<float>(120, 160, 3.0f)};
    prediction.labels.setTo(1, first.Truth(1));
    Split(second, missed ? std::vector<InstanceMask>{} : std::vector{card},
          prediction);
    return second.Truth(1);
  }
};

TEST_F(SurfaceSplitterTest, AConfidentDetectionIsBornInTheFirstFrame) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  Split(scene, {{Moved(scene.Truth(1), 2, 1), "person", 0.9}});
  EXPECT_EQ(Count("born"), 1);
  EXPECT_GT(IouOf(1, scene.Truth(1)), 0.98);
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
  EXPECT_EQ(splitter_.tracks().at(1).kind, SurfaceKind::kNonRigid);
}

TEST_F(SurfaceSplitterTest, LaterBirthsWaitForASecondDetection) {
  LayeredScene empty, scene;
  scene.Add(kCard, 2.0, 1);
  Split(empty, {});
  Split(scene, {{scene.Truth(1), "person", 0.9}});
  EXPECT_EQ(Count("pending"), 1);
  EXPECT_EQ(cv::countNonZero(last_.labels), 0);
  // Until then it must not become background.
  EXPECT_EQ(cv::countNonZero(~last_.uncertain & scene.Truth(1)), 0);
  Split(scene, {{scene.Truth(1), "person", 0.9}});
  EXPECT_EQ(Count("born"), 1);
  EXPECT_GT(IouOf(1, scene.Truth(1)), 0.98);
}

TEST_F(SurfaceSplitterTest, IdentitySurvivesMissedDetections) {
  for (int i = 0; i < 12; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add(kCard + cv::Point(2 * i, 0), 2.0 + 0.01 * i, 1);
    std::vector<InstanceMask> detections;
    if (i < 3 || i > 7) detections = {{scene.Truth(1), "person", 0.9}};
    Split(scene, detections);
    EXPECT_EQ(Count(i < 3 || i > 7 ? (i == 0 ? "born" : "matched") : "missed"),
              1)
        << i;
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.95) << i;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
}

TEST_F(SurfaceSplitterTest, IdentitySurvivesLabelFlicker) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  // A rigid class and a low score count where a surface is known.
  const std::vector<std::pair<std::string, double>> labels = {
      {"person", 0.9}, {"dog", 0.8},    {"chair", 0.9},
      {"kite", 0.5},   {"person", 0.9}, {"teddy bear", 0.2}};
  for (const auto& [name, score] : labels) {
    Split(scene, {{scene.Truth(1), name, score}});
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.98) << name;
  }
  EXPECT_EQ(splitter_.tracks().size(), 1u);
  EXPECT_EQ(splitter_.tracks().at(1).class_name, "person");
}

TEST_F(SurfaceSplitterTest, TwoPiecesAreOneSurface) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  const InstanceMask head{RectMask({50, 25, 40, 20}), "person", 0.8};
  const InstanceMask body{RectMask({50, 45, 40, 50}), "person", 0.9};
  for (int i = 0; i < 3; ++i) {
    Split(scene, {body, head});  // At birth already.
    EXPECT_EQ(Count("merged"), 1) << i;
    EXPECT_GT(IouOf(1, scene.Truth(1)), 0.97) << i;
  }
  Split(scene, {{scene.Truth(1), "person", 0.9}});
  EXPECT_GT(IouOf(1, scene.Truth(1)), 0.98);
  EXPECT_EQ(splitter_.tracks().size(), 1u);
}

TEST_F(SurfaceSplitterTest, TheMasksOfTheSegmenterAreLeftAsTheyAre) {
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  const std::vector<InstanceMask> detections = {
      {RectMask({50, 45, 40, 50}), "person", 0.9},
      {RectMask({50, 25, 40, 20}), "person", 0.8},
      {RectMask({110, 50, 20, 20}), "chair", 0.9}};
  std::vector<cv::Mat> before;
  for (const InstanceMask& detection : detections) {
    before.push_back(detection.mask.clone());
  }
  for (int i = 0; i < 3; ++i) {
    Split(scene, detections);
    for (std::size_t j = 0; j < before.size(); ++j) {
      EXPECT_EQ(cv::norm(detections[j].mask, before[j]), 0) << j;
    }
  }
}

TEST_F(SurfaceSplitterTest, SpuriousDetectionsDoNotBecomeSurfaces) {
  LayeredScene scene;
  scene.Add({20, 50, 50, 60}, 2.5, 1).Add({90, 30, 40, 70}, 2.0, 2);
  const InstanceMask chair{scene.Truth(1), "chair", 0.95};
  const InstanceMask weak{scene.Truth(2), "person", 0.2};
  for (int i = 0; i < 20; ++i) {
    std::vector<InstanceMask> detections = {chair, weak};
    if (i == 15) detections.push_back({scene.Truth(1), "dog", 0.9});
    Split(scene, detections);
    EXPECT_EQ(cv::countNonZero(last_.labels), 0) << i;
  }
  EXPECT_TRUE(splitter_.tracks().empty());
  // The chair is background, the weak person is left alone.
  EXPECT_LT(cv::countNonZero(last_.uncertain & scene.Truth(1)), 100);
  EXPECT_EQ(cv::countNonZero(~last_.uncertain & scene.Truth(2)), 0);
}

TEST_F(SurfaceSplitterTest, RigidClassesAreSurfacesOnRequest) {
  SplitOptions options = SceneOptions();
  options.rigid_objects = "separate";
  UseOptions(options);
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  Split(scene, {{scene.Truth(1), "chair", 0.9}});
  EXPECT_EQ(splitter_.tracks().at(1).kind, SurfaceKind::kRigid);
  EXPECT_GT(IouOf(1, scene.Truth(1)), 0.98);
}

TEST_F(SurfaceSplitterTest, TwoPeopleCrossWithoutMixing) {
  for (int i = 0; i < 24; ++i) {
    LayeredScene scene(3.0, i);
    scene.Add({10 + 4 * i, 30, 30, 70}, 1.5, 1);
    scene.Add({110 - 4 * i, 30, 30, 70}, 2.2, 2);
    std::vector<InstanceMask> detections;
    for (const int id : {1, 2}) {
      const cv::Mat_<uchar> truth = scene.Truth(id);
      if (cv::countNonZero(truth) > 200 && (i + id) % 5 != 0) {
        detections.push_back({truth, "person", 0.9});
      }
    }
    Split(scene, detections);
    for (const int id : {1, 2}) {
      const cv::Mat_<uchar> truth = scene.Truth(id);
      if (cv::countNonZero(truth) < 600) continue;
      EXPECT_GT(IouOf(id, truth), 0.9) << "frame " << i << " card " << id;
    }
  }
  EXPECT_EQ(splitter_.tracks().size(), 2u);
}

TEST_F(SurfaceSplitterTest, WhoLeavesComesBackUnderTheSameId) {
  const auto step = [&](int x) {
    LayeredScene scene(3.0, next_frame_);
    scene.Add({x, 25, 40, 70}, 2.0, 1);
    std::vector<InstanceMask> detections;
    if (cv::countNonZero(scene.Truth(1)) > 0) {
      detections.push_back({scene.Truth(1), "person", 0.9});
    }
    Split(scene, detections);
  };
  for (const int x : {80, 95, 110, 125, 140, 155}) step(x);
  for (int i = 0; i < 16; ++i) step(160);
  EXPECT_FALSE(splitter_.tracks().at(1).followed());
  for (const int x : {140, 130, 120, 110, 100}) step(x);
  EXPECT_TRUE(splitter_.tracks().at(1).followed());
  EXPECT_EQ(splitter_.tracks().size(), 1u);
  EXPECT_GT(IouOf(1, RectMask({100, 25, 40, 70})), 0.97);
}

TEST_F(SurfaceSplitterTest, AForgottenSurfaceGoesDormantAtLast) {
  SplitOptions options = SceneOptions();
  options.max_missed_frames = 3;
  UseOptions(options);
  LayeredScene scene;
  scene.Add(kCard, 2.0, 1);
  Split(scene, {{scene.Truth(1), "person", 0.9}});
  for (int i = 0; i < 3; ++i) Split(scene, {});
  EXPECT_EQ(Count("missed"), 1);
  Split(scene, {});
  EXPECT_EQ(Count("inactive"), 1);
  EXPECT_EQ(cv::countNonZero(last_.labels), 0);
}

TEST_F(SurfaceSplitterTest, UsesThePredictionOfATracker) {
  LayeredScene first, second;
  first.Add(kCard, 2.0, 1);
  Split(first, {{first.Truth(1), "person", 0.9}});
  second.Add({110, 25, 40, 70}, 2.0, 1);  // Too far without prediction.
  SurfacePrediction prediction{
      LabelImage(120, 160, std::uint16_t(0)), second.depth().clone(), {}};
  prediction.labels.setTo(1, second.Truth(1));
  Split(second, {}, prediction);
  EXPECT_GT(IouOf(1, second.Truth(1)), 0.97);
}

TEST_F(SurfaceSplitterTest, AMissedSurfaceKeepsTheArmThatItRaises) {
  const cv::Mat_<uchar> truth = RaiseArm(/*missed=*/true);
  EXPECT_GT(IouOf(1, truth), 0.95);
}

TEST_F(SurfaceSplitterTest, WhatStandsOutOfASurfaceIsNotBackground) {
  RaiseArm(/*missed=*/false);
  const cv::Mat known = (last_.labels > 0) | last_.uncertain;
  EXPECT_EQ(cv::countNonZero(known(kArm)), kArm.area());
}

TEST_F(SurfaceSplitterTest, TheSameInputGivesTheSameResult) {
  const auto run = [] {
    SurfaceSplitter splitter(SceneCamera(), LabelTable(), SceneOptions());
    LayeredScene scene(3.0, 9);
    scene.Add(kCard, 2.0, 1).Add({70, 60, 50, 50}, 1.6, 2);
    cv::Mat joined;
    for (int i = 0; i < 3; ++i) {
      const Frame frame = scene.MakeFrame(i);
      const SplitResult result =
          splitter.Split(frame, ComputePointMap(frame.depth, SceneCamera()),
                         {{Moved(scene.Truth(1), 2, 1), "person", 0.9},
                          {Moved(scene.Truth(2), -2, 1), "dog", 0.9}},
                         {});
      joined.push_back(cv::Mat(result.labels));
    }
    return joined;
  };
  EXPECT_EQ(cv::norm(run(), run(), cv::NORM_INF), 0);
}

TEST_F(SurfaceSplitterTest, NamesBadInput) {
  LayeredScene scene;
  Frame frame = scene.MakeFrame(0);
  const auto split = [&](const std::vector<InstanceMask>& detections) {
    splitter_.Split(frame, {}, detections, {});
  };
  ExpectInputError(
      [&] {
        split({{cv::Mat_<uchar>(10, 20, uchar(0)), "dog", 1.0}});
      },
      "mask of 'dog' is 20x10: expected 160x120");
  frame.depth = cv::Mat_<float>(60, 80, 1.0f);
  ExpectInputError([&] { split({}); }, "depth image is 80x60");
  SplitOptions options;
  options.min_score = 1.5;
  ExpectInputError([&] { UseOptions(options); }, "min_score = 1.5");
  options = {};
  options.birth_frames = 0;
  ExpectInputError([&] { UseOptions(options); }, "birth_frames = 0");
}

TEST(SurfaceSplitterOnData, KeepsTwoPeopleApart) {
  const std::string folder = SharedData("walking_xyz");
  SKIP_WITHOUT_SHARED_DATA(folder, "walking_xyz");
  ReaderOptions reader_options;
  reader_options.first_frame = 44;
  reader_options.max_frames = 26;
  ImageFolderReader reader(folder, reader_options);
  MaskFolderSegmenter segmenter(FindMaskFolder(folder));
  SurfaceSplitter splitter(reader.camera(), LabelTable(), {});
  double sum = 0;
  int count = 0;
  while (const std::optional<Frame> frame = reader.Next()) {
    const SplitResult result =
        splitter.Split(*frame, ComputePointMap(frame->depth, reader.camera()),
                       segmenter.Segment(*frame), {});
    const cv::Mat truth = cv::imread(
        folder + "/gt/label/" + frame->stem + ".png", cv::IMREAD_UNCHANGED);
    const cv::Mat measured = frame->depth > 0;
    for (const int person : {1, 2}) {
      sum += Iou((result.labels == person) & measured,
                 (truth == person) & measured);
      ++count;
    }
  }
  EXPECT_EQ(splitter.tracks().size(), 2u);
  EXPECT_GT(sum / count, 0.93);
}

}  // namespace
}  // namespace splitfusion
