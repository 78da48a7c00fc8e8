#ifndef SPLITFUSION_LIB_EVALUATION_ERROR_HISTOGRAM_H_
#define SPLITFUSION_LIB_EVALUATION_ERROR_HISTOGRAM_H_

#include <vector>

#include "splitfusion/lib/evaluation/error_statistics.h"

namespace splitfusion {

/// Statistics of any number of non-negative errors in memory that does not grow
/// with it. Quantiles are known to the width of a bin; those beyond the last
/// bin lie between it and the greatest error.
class ErrorHistogram {
 public:
  /// `bin_width` in the unit of the errors, `bins` > 0; by default bins of
  /// 0.1 mm up to 1 m.
  explicit ErrorHistogram(double bin_width = 1e-4, int bins = 10000);

  /// Adds one error.
  void Add(double error);

  /// Statistics of the errors so far; median and p90 from the bins, the others
  /// exact.
  ErrorStatistics Statistics() const;

 private:
  double Quantile(double q) const;

  double bin_width_;
  std::vector<int> bins_;  // The last one: all beyond the others.
  int count_ = 0;
  double sum_ = 0;
  double squares_ = 0;
  double max_ = 0;
};

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_ERROR_HISTOGRAM_H_
