#include "splitfusion/lib/evaluation/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace splitfusion {

ErrorStatistics Summarize(std::vector<double> errors) {
  ErrorStatistics result;
  if (errors.empty()) return result;
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  const double squares =
      std::inner_product(errors.begin(), errors.end(), errors.begin(), 0.0);
  result.count = static_cast<int>(errors.size());
  result.rmse = std::sqrt(squares / count);
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / count;
  result.median = Quantile(errors, 0.5);
  result.p90 = Quantile(errors, 0.9);
  result.max = errors.back();
  return result;
}

double Quantile(const std::vector<double>& ascending, double q) {
  if (ascending.empty()) return 0;
  const double place = q * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  const double fraction = place - static_cast<double>(below);
  return ascending[below] + fraction * (ascending[above] - ascending[below]);
}

double FractionWithin(const std::vector<double>& errors, double threshold) {
  if (errors.empty()) return 0;
  const auto within =
      std::count_if(errors.begin(), errors.end(),
                    [threshold](double e) { return e <= threshold; });
  return static_cast<double>(within) / static_cast<double>(errors.size());
}

}  // namespace splitfusion
