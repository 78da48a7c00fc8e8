#include "splitfusion/lib/synthetic/detections.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace splitfusion {
namespace {

const std::map<int, std::string> kClasses = {{1, "person"}, {3, "chair"}};

/// A disc of label 1, a box of label 3, a speck of label 2.
cv::Mat Labels() {
  cv::Mat labels = cv::Mat::zeros(480, 640, CV_8UC1);
  cv::circle(labels, {200, 240}, 90, 1, cv::FILLED);
  cv::rectangle(labels, cv::Rect(420, 200, 120, 180), 3, cv::FILLED);
  cv::circle(labels, {60, 60}, 20, 2, cv::FILLED);
  return labels;
}

double IntersectionOverUnion(const cv::Mat& a, const cv::Mat& b) {
  return cv::countNonZero(a & b) / static_cast<double>(cv::countNonZero(a | b));
}

TEST(ImitateDetections, AnExactDetectorReturnsTheLabels) {
  const auto found = ImitateDetections(Labels(), kClasses, ExactDetector(), 1);
  ASSERT_EQ(found.size(), 2u);
  for (const InstanceMask& mask : found) {
    const int id = mask.class_name == "person" ? 1 : 3;
    EXPECT_EQ(mask.class_name, kClasses.at(id));
    EXPECT_EQ(cv::countNonZero(mask.mask != (Labels() == id)), 0);
  }
}

TEST(ImitateDetections, BordersWobbleButMasksStayGood) {
  DetectorFaults faults;
  faults.miss_chance = 0;
  faults.wrong_class_chance = 0;
  for (const InstanceMask& mask :
       ImitateDetections(Labels(), kClasses, faults, 4)) {
    const int id = mask.class_name == "person" ? 1 : 3;
    const double iou = IntersectionOverUnion(mask.mask, Labels() == id);
    EXPECT_GT(iou, 0.85);
    EXPECT_LT(iou, 0.99);
  }
}

TEST(ImitateDetections, MissesAndErrsAsOftenAsAsked) {
  const DetectorFaults faults;
  cv::Mat labels;
  cv::resize(Labels(), labels, {160, 120}, 0, 0, cv::INTER_NEAREST);
  int found = 0, wrong = 0;
  for (std::uint32_t seed = 0; seed < 150; ++seed) {
    for (const InstanceMask& mask :
         ImitateDetections(labels, {{1, "person"}}, faults, seed)) {
      ++found;
      wrong += mask.class_name != "person";
      EXPECT_GT(mask.score, 0.4);
      EXPECT_LT(mask.score, 1.0);
    }
  }
  EXPECT_NEAR(found / 150.0, 1 - faults.miss_chance, 0.06);
  EXPECT_LE(wrong, 9);
}

TEST(ImitateDetections, SmallInstancesAreNotFound) {
  DetectorFaults faults;
  faults.miss_chance = 0;
  const std::map<int, std::string> speck = {{2, "cup"}};
  faults.min_area = 0.001;
  EXPECT_EQ(ImitateDetections(Labels(), speck, faults, 1).size(), 1u);
  faults.min_area = 0.01;
  EXPECT_TRUE(ImitateDetections(Labels(), speck, faults, 1).empty());
}

TEST(ImitateDetections, BestScoreComesFirst) {
  DetectorFaults faults;
  faults.miss_chance = 0;
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    const auto found = ImitateDetections(Labels(), kClasses, faults, seed);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_GE(found[0].score, found[1].score);
  }
}

TEST(ImitateDetections, SameSeedSameMasks) {
  const auto a = ImitateDetections(Labels(), kClasses, {}, 9);
  const auto b = ImitateDetections(Labels(), kClasses, {}, 9);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(cv::countNonZero(a[i].mask != b[i].mask), 0);
    EXPECT_EQ(a[i].score, b[i].score);
  }
}

}  // namespace
}  // namespace splitfusion
