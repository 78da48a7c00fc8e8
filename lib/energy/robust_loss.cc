#include "splitfusion/lib/energy/robust_loss.h"

#include <algorithm>
#include <utility>

#include "splitfusion/lib/base/any_of.h"
#include "splitfusion/lib/base/error.h"

namespace splitfusion {
namespace {

const std::vector<std::pair<std::string, LossKind>>& Losses() {
  static const std::vector<std::pair<std::string, LossKind>> losses = {
      {"trivial", LossKind::kTrivial},
      {"huber", LossKind::kHuber},
      {"tukey", LossKind::kTukey},
      {"cauchy", LossKind::kCauchy}};
  return losses;
}

}  // namespace

std::vector<std::string> LossNames() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : Losses()) names.push_back(name);
  return names;
}

LossKind ParseLoss(const std::string& name) {
  const auto found =
      std::find_if(Losses().begin(), Losses().end(),
                   [&](const auto& loss) { return loss.first == name; });
  CheckOption(found != Losses().end(), "loss", name, AnyOf(LossNames()));
  return found->second;
}

std::string ToString(LossKind kind) {
  for (const auto& [name, value] : Losses()) {
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
      return std::make_unique<ceres::TrivialLoss>();
  }
  return nullptr;
}

}  // namespace splitfusion
