#include "splitfusion/lib/energy/pcg.h"

#include <cmath>

#include "splitfusion/lib/energy/block_kernels.h"

namespace splitfusion {
namespace {

double Dot(const std::vector<Vector6>& a, const std::vector<Vector6>& b) {
  return DotProduct(6 * static_cast<int>(a.size()), a.data()->data(),
                    b.data()->data());
}

}  // namespace

CgResult SolveByPcg(const SymmetricBlockMatrix& a,
                    const Preconditioner& preconditioner,
                    const std::vector<Vector6>& b, double tolerance,
                    int max_iterations, std::vector<Vector6>* x) {
  const int n = 6 * static_cast<int>(b.size());
  x->assign(b.size(), Vector6::Zero());
  std::vector<Vector6> residual = b, z(b.size()), product(b.size());
  double rz = preconditioner.Apply(residual, &z);
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
    const double next = preconditioner.Apply(residual, &z);
    NextDirection(n, next / rz, z.data()->data(), direction.data()->data());
    rz = next;
  }
  return result;
}

}  // namespace splitfusion
