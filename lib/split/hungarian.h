#ifndef SPLITFUSION_LIB_SPLIT_HUNGARIAN_H_
#define SPLITFUSION_LIB_SPLIT_HUNGARIAN_H_

#include <opencv2/core.hpp>
#include <vector>

namespace splitfusion {

/// The one-to-one assignment of rows to columns with the greatest sum of gains
/// (Kuhn 1955, by shortest augmenting paths). Pairs without gain, <= 0, are
/// left out. Returns the column of every row, -1 for none.
std::vector<int> AssignRows(const cv::Mat_<double>& gains);

}  // namespace splitfusion

#endif  // SPLITFUSION_LIB_SPLIT_HUNGARIAN_H_
