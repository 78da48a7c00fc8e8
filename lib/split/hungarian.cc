#include "splitfusion/lib/split/hungarian.h"

#include <algorithm>
#include <limits>

namespace splitfusion {
namespace {

/// Shortest augmenting paths over a cost matrix with a free column for every
/// row behind the others. Columns count from 1: column 0 holds the row that is
/// being placed.
class Assignment {
 public:
  explicit Assignment(const cv::Mat_<double>& gains)
      : gains_(gains),
        columns_(gains.cols + gains.rows),
        row_price_(gains.rows + 1, 0.0),
        column_price_(columns_ + 1, 0.0),
        row_of_(columns_ + 1, 0) {}

  std::vector<int> Solve() {
    for (int row = 1; row <= gains_.rows; ++row) Place(row);
    std::vector<int> column_of(gains_.rows, -1);
    for (int column = 1; column <= gains_.cols; ++column) {
      const int row = row_of_[column];
      if (row > 0 && Cost(row, column) < 0) column_of[row - 1] = column - 1;
    }
    return column_of;
  }

 private:
  double Cost(int row, int column) const {
    if (column > gains_.cols) return 0;
    return -std::max(0.0, gains_(row - 1, column - 1));
  }

  void Place(int row) {
    const double infinity = std::numeric_limits<double>::infinity();
    std::vector<double> slack(columns_ + 1, infinity);
    std::vector<int> came_from(columns_ + 1, 0);
    std::vector<bool> done(columns_ + 1, false);
    int column = 0;
    row_of_[0] = row;
    do {
      done[column] = true;
      double least = infinity;
      int next = 0;
      for (int j = 1; j <= columns_; ++j) {
        if (done[j]) continue;
        const int i = row_of_[column];
        const double reduced = Cost(i, j) - row_price_[i] - column_price_[j];
        if (reduced < slack[j]) {
          slack[j] = reduced;
          came_from[j] = column;
        }
        if (slack[j] < least) {
          least = slack[j];
          next = j;
        }
      }
      for (int j = 0; j <= columns_; ++j) {
        if (done[j]) {
          row_price_[row_of_[j]] += least;
          column_price_[j] -= least;
        } else {
          slack[j] -= least;
        }
      }
      column = next;
    } while (row_of_[column] != 0);
    for (; column != 0; column = came_from[column]) {
      row_of_[column] = row_of_[came_from[column]];
    }
  }

  const cv::Mat_<double>& gains_;
  const int columns_;
  std::vector<double> row_price_, column_price_;
  std::vector<int> row_of_;  // 0: free.
};

}  // namespace

std::vector<int> AssignRows(const cv::Mat_<double>& gains) {
  return Assignment(gains).Solve();
}

}  // namespace splitfusion
