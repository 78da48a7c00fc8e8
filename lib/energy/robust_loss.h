#ifndef SPLITFUSION_LIB_ENERGY_ROBUST_LOSS_H_
#define SPLITFUSION_LIB_ENERGY_ROBUST_LOSS_H_

#include <ceres/loss_function.h>

#include <memory>
#include <string>
#include <vector>

namespace splitfusion {

/// Robust losses by their names on the command line.
enum class LossKind { kTrivial, kHuber, kTukey, kCauchy };

/// All names, as ParseLoss() takes them.
std::vector<std::string> LossNames();

/// @throw InputError on an unknown name; lists the known ones.
LossKind ParseLoss(const std::string& name);

/// Name as ParseLoss takes it.
std::string ToString(LossKind kind);

/// Ceres' loss of that kind with inlier width `scale`, in units of the residual
/// it is applied to. Null if there is none of that kind.
std::unique_ptr<ceres::LossFunction> MakeLoss(LossKind kind, double scale);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_ENERGY_ROBUST_LOSS_H_
