#include "splitfusion/lib/energy/corner_sums.h"

#include <algorithm>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {

void CornerSums::Clear(int block) {
  std::fill_n(sums_.begin() + Stride() * block, Stride(), 0.0);
}

void CornerSums::Add(int block, int rows, const double* residuals,
                     const double* derivatives) {
  if (unknowns_ == 0) return;
  double* gradient = &sums_[Stride() * block];
  double* corner = gradient + unknowns_;
  for (int u = 0; u < unknowns_; ++u) {
    const double* own = derivatives + rows * u;
    gradient[u] += DotProduct(rows, own, residuals);
    for (int v = 0; v <= u; ++v) {
      corner[unknowns_ * u + v] +=
          DotProduct(rows, own, derivatives + rows * v);
    }
  }
}

void CornerSums::AddTo(int first, Eigen::MatrixXd* corner,
                       Eigen::VectorXd* gradient) const {
  using RowMajor =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  if (unknowns_ == 0) return;
  for (std::size_t at = 0; at < sums_.size(); at += Stride()) {
    gradient->segment(first, unknowns_) +=
        Eigen::Map<const Eigen::VectorXd>(&sums_[at], unknowns_);
    corner->block(first, first, unknowns_, unknowns_) +=
        Eigen::Map<const RowMajor>(&sums_[at + unknowns_], unknowns_, unknowns_)
            .selfadjointView<Eigen::Lower>()
            .toDenseMatrix();
  }
}

}  // namespace splitfusion
