#include "splitfusion/lib/energy/robust_loss.h"

#include <map>

#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

const std::map<std::string, LossKind>& LossNames() {
  static const std::map<std::string, LossKind> names = {
      {"trivial", LossKind::kTrivial},
      {"huber", LossKind::kHuber},
      {"tukey", LossKind::kTukey},
      {"cauchy", LossKind::kCauchy}};
  return names;
}

}  // namespace

LossKind ParseLoss(const std::string& name) {
  const auto found = LossNames().find(name);
  CheckOption(found != LossNames().end(), "loss", name,
              "trivial, huber, tukey or cauchy");
  return found->second;
}

std::string ToString(LossKind kind) {
  for (const auto& [name, value] : LossNames()) {
    if (value == kind) return name;
  }
  return "unknown";
}

std::unique_ptr<ceres::LossFunction> MakeLoss(LossKind kind, double scale) {
  switch (kind) {
    case LossKind::kHuber:
      return std::make_unique<ceres::HuberLoss>(scale);
    case LossKind::kTukey:
      return std::make_unique<ceres::TukeyLoss>(scale);
    case LossKind::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
    case LossKind::kTrivial:
      break;
  }
  return std::make_unique<ceres::TrivialLoss>();
}

}  // namespace splitfusion
