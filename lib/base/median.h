#ifndef SPLITFUSION_LIB_BASE_MEDIAN_H_
#define SPLITFUSION_LIB_BASE_MEDIAN_H_

#include <algorithm>
#include <vector>

namespace splitfusion {

/// Median, the mean of the two in the middle of an even number; 0 if there are
/// none.
template <typename T>
T Median(std::vector<T> values) {
  if (values.empty()) return T(0);
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*std::max_element(values.begin(), middle) + *middle) / 2;
}

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_BASE_MEDIAN_H_
