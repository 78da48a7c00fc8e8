#include "splitfusion/lib/energy/residual_sink.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/warped_points.h"

namespace splitfusion {

void ResidualSink::DemandFirst(const char* member, bool called) {
  if (!called) return;
  throw InputError(std::string(member) + " twice: expected one call");
}

void ResidualSink::Count(std::size_t vectors, std::size_t functors,
                         double total) {
  CheckOption(functors == vectors, "functors of residuals", functors,
              "one for each of " + std::to_string(vectors));
  CheckOption(total >= 0, "total of residuals", total, "0 or more");
  residual_vectors_ = static_cast<int>(vectors);
  total_ = total > 0 ? total : static_cast<double>(vectors);
}

void ResidualSink::CheckTuples(
    const std::vector<std::vector<int>>& nodes) const {
  for (const std::vector<int>& tuple : nodes) {
    CheckNodes(tuple.data(), tuple.size(), cache_->nodes());
    for (std::size_t i = 1; i < tuple.size(); ++i) {
      const auto end = tuple.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::find(tuple.begin(), end, tuple[i]) == end) continue;
      throw OptionError("nodes of a residual",
                        NodesText(tuple.data(), tuple.size()),
                        "different nodes");
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
