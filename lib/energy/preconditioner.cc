#include "splitfusion/lib/energy/preconditioner.h"

#include <Eigen/Cholesky>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/block_ic0.h"
#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

/// No preconditioning.
class Identity : public Preconditioner {
 public:
  double Apply(const std::vector<Vector6>& in,
               std::vector<Vector6>* out) const override {
    *out = in;
    return DotProduct(6 * static_cast<int>(in.size()), in.data()->data(),
                      in.data()->data());
  }
};

/// Inverses of the diagonal blocks.
class BlockJacobi : public Preconditioner {
 public:
  explicit BlockJacobi(const SymmetricBlockMatrix& matrix)
      : inverse_(matrix.size()) {
    for (int i = 0; i < matrix.size(); ++i) {
      const Block6 inverse = matrix.Diagonal(i).ldlt().solve(
          Eigen::Matrix<double, 6, 6>::Identity());
      inverse_[i] = 0.5 * (inverse + inverse.transpose());
    }
  }

  double Apply(const std::vector<Vector6>& in,
               std::vector<Vector6>* out) const override {
    return MultiplyDiagonal(static_cast<int>(in.size()),
                            inverse_.data()->data(), in.data()->data(),
                            out->data()->data());
  }

 private:
  Blocks6 inverse_;
};

}  // namespace

std::unique_ptr<Preconditioner> MakePreconditioner(
    const std::string& name, const SymmetricBlockMatrix& matrix) {
  if (name == "identity") return std::make_unique<Identity>();
  if (name == "block_ic0") return std::make_unique<BlockIc0>(matrix);
  CheckOption(name == "jacobi", "preconditioner", name,
              "identity, jacobi or block_ic0");
  return std::make_unique<BlockJacobi>(matrix);
}

}  // namespace splitfusion
