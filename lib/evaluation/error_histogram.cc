#include "splitfusion/lib/evaluation/error_histogram.h"

#include <algorithm>
#include <cmath>

namespace splitfusion {

ErrorHistogram::ErrorHistogram(double bin_width, int bins)
    : bin_width_(bin_width), bins_(bins + 1, 0) {}

void ErrorHistogram::Add(double error) {
  const double last = static_cast<double>(bins_.size() - 1);
  ++bins_[static_cast<std::size_t>(std::min(error / bin_width_, last))];
  ++count_;
  sum_ += error;
  squares_ += error * error;
  max_ = std::max(max_, error);
}

double ErrorHistogram::Quantile(double q) const {
  double left = q * count_;  // Errors below the quantile.
  std::size_t bin = 0;
  while (bin + 1 < bins_.size() && left > bins_[bin]) left -= bins_[bin++];
  const double begin = static_cast<double>(bin) * bin_width_;
  const double end =
      bin + 1 < bins_.size() ? std::min(begin + bin_width_, max_) : max_;
  return begin + (end - begin) * left / std::max(bins_[bin], 1);
}

ErrorStatistics ErrorHistogram::Statistics() const {
  ErrorStatistics result;
  if (count_ == 0) return result;
  result.count = count_;
  result.rmse = std::sqrt(squares_ / count_);
  result.mean = sum_ / count_;
  result.median = Quantile(0.5);
  result.p90 = Quantile(0.9);
  result.max = max_;
  return result;
}

}  // namespace splitfusion
