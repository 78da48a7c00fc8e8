#include "splitfusion/lib/energy/pcg.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "splitfusion/lib/base/error.h"
#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

/// out = M^-1 in; returns in . out.
double Apply(const Blocks6& preconditioner, const std::vector<Vector6>& in,
             std::vector<Vector6>* out) {
  return MultiplyDiagonal(static_cast<int>(in.size()),
                          preconditioner.data()->data(), in.data()->data(),
                          out->data()->data());
}

}  // namespace

Blocks6 MakePreconditioner(const std::string& name,
                           const ReducedMatrix& matrix) {
  CheckOption(name == "auto" || name == "jacobi" || name == "identity",
              "preconditioner", name, "auto, jacobi or identity");
  Blocks6 inverses(matrix.size(), Block6::Identity());
  if (name == "identity") return inverses;
  for (int i = 0; i < matrix.size(); ++i) {
    const Block6 inverse = matrix.Diagonal(i).ldlt().solve(
        Eigen::Matrix<double, 6, 6>::Identity());
    inverses[i] = 0.5 * (inverse + inverse.transpose());
  }
  return inverses;
}

CgResult SolveByPcg(const ReducedMatrix& a, const Blocks6& preconditioner,
                    const std::vector<Vector6>& b, double tolerance,
                    int max_iterations, std::vector<Vector6>* x) {
  const int n = 6 * static_cast<int>(b.size());
  x->assign(b.size(), Vector6::Zero());
  std::vector<Vector6> residual = b, z(b.size()), product(b.size());
  double rz = Apply(preconditioner, residual, &z);
  std::vector<Vector6> direction = z;
  const double norm_b = std::sqrt(Dot(b, b));
  CgResult result;
  result.relative_residual = norm_b > 0 ? 1 : 0;
  while (result.iterations < max_iterations &&
         result.relative_residual > tolerance) {
    a.Multiply(direction, &product);
    const double curvature = Dot(direction, product);
    if (!(curvature > 0)) break;
    const double squared = StepAndResidual(
        n, rz / curvature, direction.data()->data(), product.data()->data(),
        x->data()->data(), residual.data()->data());
    ++result.iterations;
    result.relative_residual = std::sqrt(squared) / norm_b;
    const double next = Apply(preconditioner, residual, &z);
    NextDirection(n, next / rz, z.data()->data(), direction.data()->data());
    rz = next;
  }
  return result;
}

}  // namespace splitfusion
