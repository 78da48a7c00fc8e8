#include "splitfusion/lib/evaluation/motion_calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

/// Normal errors whose deviations are said to be 1 / `scale` of what they are.
std::vector<MotionError> NormalErrors(double scale) {
  std::mt19937 random(1);
  // Box and Muller: not std::normal_distribution, which differs by library.
  const auto uniform = [&] { return (random() + 0.5) / 4294967296.0; };
  std::vector<MotionError> errors(20000);
  for (MotionError& e : errors) {
    for (int axis = 0; axis < 3; ++axis) {
      const double sigma = 0.001 * (1 + uniform());
      e.sigma[axis] = sigma / scale;
      e.error[axis] = sigma * std::sqrt(-2 * std::log(uniform())) *
                      std::cos(2 * M_PI * uniform());
    }
  }
  return errors;
}

TEST(Calibrate, FindsNormalErrorsToBeNormal) {
  const MotionCalibration found = Calibrate(NormalErrors(1), 1);
  EXPECT_EQ(found.points, 20000);
  EXPECT_NEAR(found.fitted_scale, 1, 0.02);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(found.within_two[axis], 0.954, 0.006);
    for (const auto& [expected, observed] : found.curves[axis]) {
      EXPECT_NEAR(observed, expected, 0.015);
    }
  }
}

TEST(Calibrate, FindsTheScaleOfDeviationsThatAreTooSmall) {
  const std::vector<MotionError> errors = NormalErrors(3);
  const MotionCalibration found = Calibrate(errors, 1);
  EXPECT_NEAR(found.fitted_scale, 3, 0.06);
  EXPECT_NEAR(found.within_two[0], std::erf(2 / 3.0 / std::sqrt(2.0)), 0.015);
  const MotionCalibration scaled = Calibrate(errors, found.fitted_scale);
  EXPECT_NEAR(scaled.within_two[1], 0.954, 0.006);
  EXPECT_EQ(scaled.fitted_scale, found.fitted_scale);
  EXPECT_EQ(ToJson(scaled)["within_two"].size(), 3u);
}

TEST(Calibrate, NoPointsSayNothing) {
  const MotionCalibration found = Calibrate({}, 1);
  EXPECT_EQ(found.points, 0);
  EXPECT_EQ(found.fitted_scale, 0);
  EXPECT_EQ(found.within_two[2], 0);
}

TEST(Calibrate, RefusesScalesThatAreNone) {
  ExpectInputError([] { Calibrate({}, 0); },
                   "uncertainty_scale = 0: expected > 0");
}

}  // namespace
}  // namespace splitfusion
