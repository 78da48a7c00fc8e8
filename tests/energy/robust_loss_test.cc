#include "splitfusion/lib/energy/robust_loss.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/expect_input_error.h"

namespace splitfusion {
namespace {

double Rho(LossKind kind, double scale, double residual) {
  double rho[3];
  MakeLoss(kind, scale)->Evaluate(residual * residual, rho);
  return rho[0];
}

TEST(RobustLoss, NamesRoundTrip) {
  for (const char* name : {"trivial", "huber", "tukey", "cauchy"}) {
    EXPECT_EQ(ToString(ParseLoss(name)), name);
  }
  ExpectInputError([] { ParseLoss("Huber"); },
                   "loss = Huber: expected trivial, huber, tukey or cauchy");
}

TEST(RobustLoss, ValuesByHand) {
  EXPECT_DOUBLE_EQ(Rho(LossKind::kTrivial, 1, 3), 9);
  // 2 a |r| - a^2 beyond a.
  EXPECT_DOUBLE_EQ(Rho(LossKind::kHuber, 2, 1), 1);
  EXPECT_DOUBLE_EQ(Rho(LossKind::kHuber, 2, 5), 16);
  // a^2 / 3 (1 - (1 - r^2 / a^2)^3), flat beyond a.
  EXPECT_DOUBLE_EQ(Rho(LossKind::kTukey, 2, 1), 4.0 / 3 * (1 - 27.0 / 64));
  EXPECT_DOUBLE_EQ(Rho(LossKind::kTukey, 2, 2), 4.0 / 3);
  EXPECT_DOUBLE_EQ(Rho(LossKind::kTukey, 2, 50), 4.0 / 3);
  EXPECT_DOUBLE_EQ(Rho(LossKind::kCauchy, 2, 2), 4 * std::log(2));
}

TEST(RobustLoss, AllAgreeWithTheSquareForSmallResiduals) {
  for (const char* name : {"trivial", "huber", "tukey", "cauchy"}) {
    EXPECT_NEAR(Rho(ParseLoss(name), 1, 1e-3), 1e-6, 2e-12) << name;
  }
}

TEST(RobustLoss, AllAreConcaveInTheSquaredResidual) {
  // ResidualScaling relies on rho'' <= 0.
  for (const char* name : {"trivial", "huber", "tukey", "cauchy"}) {
    const auto loss = MakeLoss(ParseLoss(name), 1.5);
    for (double s = 0; s < 10; s += 0.05) {
      double rho[3];
      loss->Evaluate(s, rho);
      EXPECT_LE(rho[2], 0) << name;
      EXPECT_GE(rho[1], 0) << name;
      EXPECT_GE(rho[0] - rho[1] * s, -1e-12) << name;
    }
  }
}

}  // namespace
}  // namespace splitfusion
