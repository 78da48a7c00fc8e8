#ifndef SPLITFUSION_LIB_EVALUATION_ERROR_STATISTICS_H_
#define SPLITFUSION_LIB_EVALUATION_ERROR_STATISTICS_H_

#include <vector>

namespace splitfusion {

/// Statistics of non-negative errors, in the unit of the errors. All zero if
/// there were none.
struct ErrorStatistics {
  int count = 0;      ///< Number of errors.
  double rmse = 0;    ///< Root of the mean square.
  double mean = 0;    ///< Arithmetic mean.
  double median = 0;  ///< 0.5 quantile.
  double p90 = 0;     ///< 0.9 quantile.
  double max = 0;     ///< Largest.
};

/// Statistics of a set of errors.
ErrorStatistics Summarize(std::vector<double> errors);

/// Quantile `q` (0..1) of ascending values, linear between neighbours; 0 if
/// there are none.
double Quantile(const std::vector<double>& ascending, double q);

/// Fraction of the errors that are <= `threshold`; 0 if there are none.
double FractionWithin(const std::vector<double>& errors, double threshold);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_EVALUATION_ERROR_STATISTICS_H_
