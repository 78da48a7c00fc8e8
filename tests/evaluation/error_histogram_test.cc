#include "splitfusion/lib/evaluation/error_histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace splitfusion {
namespace {

TEST(ErrorHistogram, AgreesWithTheSortedErrors) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.02);
  ErrorHistogram histogram;
  std::vector<double> errors;
  for (int i = 0; i < 5000; ++i) {
    errors.push_back(std::abs(noise(random)));
    histogram.Add(errors.back());
  }
  const ErrorStatistics expected = Summarize(errors);
  const ErrorStatistics found = histogram.Statistics();
  EXPECT_EQ(found.count, expected.count);
  EXPECT_NEAR(found.rmse, expected.rmse, 1e-12);
  EXPECT_NEAR(found.mean, expected.mean, 1e-12);
  EXPECT_NEAR(found.median, expected.median, 1e-4);
  EXPECT_NEAR(found.p90, expected.p90, 1e-4);
  EXPECT_EQ(found.max, expected.max);
}

TEST(ErrorHistogram, ErrorsBeyondItsBinsCount) {
  ErrorHistogram histogram(0.1, 10);
  for (const double error : {0.05, 5.0, 7.0}) histogram.Add(error);
  const ErrorStatistics found = histogram.Statistics();
  EXPECT_GE(found.median, 1);
  EXPECT_LE(found.p90, 7);
  EXPECT_EQ(found.max, 7);
}

TEST(ErrorHistogram, OfNothingIsZero) {
  EXPECT_EQ(ErrorHistogram().Statistics().count, 0);
  EXPECT_EQ(ErrorHistogram().Statistics().median, 0);
}

}  // namespace
}  // namespace splitfusion
