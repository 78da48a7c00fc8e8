#include "splitfusion/lib/energy/residual_sink.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {

void ResidualSink::CheckTuples(const std::vector<std::vector<int>>& nodes) {
  for (const std::vector<int>& tuple : nodes) {
    for (std::size_t i = 1; i < tuple.size(); ++i) {
      const auto end = tuple.begin() + i;
      if (std::find(tuple.begin(), end, tuple[i]) == end) continue;
      std::string text;
      for (const int node : tuple) {
        text += (text.empty() ? "" : " ") + std::to_string(node);
      }
      throw OptionError("nodes of a residual", text, "different nodes");
    }
  }
}

const std::vector<int>& ResidualSink::SetPoints(
    const std::vector<const ModelSample*>& samples) {
  residuals_.points = cache_->Get(samples);
  return residuals_.points->source();
}

void ResidualSink::CheckUnknowns(int count) const {
  CheckOption(count == static_cast<int>(scales_.size()),
              "unknowns of a functor of term '" + options_.name + "'", count,
              std::to_string(scales_.size()) + ", as the term declares");
}

ResidualScaling ResidualSink::Units(double total) const {
  ResidualScaling scaling;
  scaling.residual_scale = 1 / kResidualUnit;
  scaling.weight_root = std::sqrt(2 * options_.weight / total);
  return scaling;
}

ResidualScaling ResidualSink::Scaling() const {
  ResidualScaling scaling = Units(total_);
  if (options_.loss != LossKind::kTrivial) {
    scaling.loss = MakeLoss(options_.loss, options_.scale / kResidualUnit);
  }
  return scaling;
}

}  // namespace splitfusion
