#include "splitfusion/lib/energy/preconditioner.h"

#include <Eigen/Cholesky>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/block_ic0.h"
#include "splitfusion/lib/energy/block_kernels.h"
#include "splitfusion/lib/energy/two_level.h"

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
      : inverse_(InverseDiagonal(matrix)) {}

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

Blocks6 InverseDiagonal(const SymmetricBlockMatrix& matrix) {
  Blocks6 inverses(matrix.size());
  for (int i = 0; i < matrix.size(); ++i) {
    const Block6 inverse = matrix.Diagonal(i).ldlt().solve(
        Eigen::Matrix<double, 6, 6>::Identity());
    inverses[i] = 0.5 * (inverse + inverse.transpose());
  }
  return inverses;
}

std::unique_ptr<Preconditioner> MakePreconditioner(
    const std::string& name, const SymmetricBlockMatrix& matrix,
    const std::vector<Eigen::Vector3d>& centers) {
  if (name == "identity") return std::make_unique<Identity>();
  if (name == "block_ic0") return std::make_unique<BlockIc0>(matrix);
  if (name == "auto" || name == "two_level") {
    return std::make_unique<TwoLevel>(matrix, centers);
  }
  CheckOption(name == "jacobi", "preconditioner", name,
              "auto, identity, jacobi, block_ic0 or two_level");
  return std::make_unique<BlockJacobi>(matrix);
}

}  // namespace splitfusion
