#include "energy_floor.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "splitfusion/lib/energy/block_kernels.h"
#include "splitfusion/lib/energy/internal/wide_vectors.h"

// A floor may round as it likes: multiplications and additions are fused.
#pragma GCC optimize("fp-contract=fast")
#if defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SPLITFUSION_FUSED __attribute__((target_clones("fma", "default")))
#else
#define SPLITFUSION_FUSED
#endif

namespace splitfusion {
namespace {

/// out += sum of a_r^T b_r over rows of six numbers, in nine registers.
inline __attribute__((always_inline)) void AddBlock(const double* a,
                                                    const double* b, int count,
                                                    int stride, double* out) {
  Vector4* sums = reinterpret_cast<Vector4*>(out);
  Vector4 s0 = sums[0], s1 = sums[1], s2 = sums[2];
  Vector4 s3 = sums[3], s4 = sums[4], s5 = sums[5];
  Vector4 s6 = sums[6], s7 = sums[7], s8 = sums[8];
  for (int r = 0; r < count; ++r, a += stride, b += stride) {
    const Vector4 low = SPLITFUSION_LOAD4(b);
    const Vector4 high = SPLITFUSION_LOAD4(b + 2);
    const Vector4 middle = SPLITFUSION_MIDDLE(low, high);
    const Vector4 a0 = SPLITFUSION_FILL4(a[0]), a1 = SPLITFUSION_FILL4(a[1]);
    const Vector4 a2 = SPLITFUSION_FILL4(a[2]), a3 = SPLITFUSION_FILL4(a[3]);
    const Vector4 a4 = SPLITFUSION_FILL4(a[4]), a5 = SPLITFUSION_FILL4(a[5]);
    s0 += a0 * low;
    s1 += SPLITFUSION_HALVES(a0, a1) * middle;
    s2 += a1 * high;
    s3 += a2 * low;
    s4 += SPLITFUSION_HALVES(a2, a3) * middle;
    s5 += a3 * high;
    s6 += a4 * low;
    s7 += SPLITFUSION_HALVES(a4, a5) * middle;
    s8 += a5 * high;
  }
  sums[0] = s0, sums[1] = s1, sums[2] = s2;
  sums[3] = s3, sums[4] = s4, sums[5] = s5;
  sums[6] = s6, sums[7] = s7, sums[8] = s8;
}

template <int kNodes>
inline __attribute__((always_inline)) void SumGroups(const FloorRows& rows,
                                                     int first, int last,
                                                     FloorMatrix* sum) {
  constexpr int kWidth = 6 * kNodes;
  const int* slot = &rows.slots[kNodes * (kNodes + 1) / 2 * first];
  for (int g = first; g < last; ++g) {
    const int count = rows.begin[g + 1] - rows.begin[g];
    const double* j = &rows.rows[kWidth * rows.begin[g]];
    const double* r = &rows.residuals[rows.begin[g]];
    for (int k = 0; k < kNodes; ++k) {
      for (int l = k; l < kNodes; ++l) {
        AddBlock(j + 6 * k, j + 6 * l, count, kWidth,
                 &sum->blocks[36 * *slot++]);
      }
    }
    double gradient[kWidth] = {};
    for (int i = 0; i < count; ++i, j += kWidth) {
      for (int b = 0; b < kWidth; ++b) gradient[b] += r[i] * j[b];
    }
    for (int k = 0; k < kNodes; ++k) {
      double* out = &sum->gradient[6 * rows.nodes[kNodes * g + k]];
      for (int d = 0; d < 6; ++d) out[d] += gradient[6 * k + d];
    }
  }
}

SPLITFUSION_FUSED
void SumPoints(const FloorRows& rows, int first, int last, FloorMatrix* sum) {
  SumGroups<6>(rows, first, last, sum);
}

SPLITFUSION_FUSED
void SumEdges(const FloorRows& rows, int first, int last, FloorMatrix* sum) {
  SumGroups<2>(rows, first, last, sum);
}

/// Inverse of a positive definite 6x6 block, by elimination.
SPLITFUSION_FUSED
void Invert(const double* block, double* inverse) {
  double m[6][12] = {};
  for (int a = 0; a < 6; ++a) {
    std::copy_n(block + 6 * a, 6, m[a]);
    m[a][6 + a] = 1;
  }
  for (int a = 0; a < 6; ++a) {
    const double scale = 1 / m[a][a];
    for (int b = 0; b < 12; ++b) m[a][b] *= scale;
    for (int row = 0; row < 6; ++row) {
      if (row == a) continue;
      const double factor = m[row][a];
      for (int b = 0; b < 12; ++b) m[row][b] -= factor * m[a][b];
    }
  }
  for (int a = 0; a < 6; ++a) std::copy_n(m[a] + 6, 6, inverse + 6 * a);
}

/// Adds the shares from the second on to the first, blocks begin..end.
SPLITFUSION_FUSED
void AddUp(std::size_t begin, std::size_t end, const double* more,
           double* sum) {
  for (std::size_t i = begin; i < end; ++i) sum[i] += more[i];
}

}  // namespace

void FloorRows::Add(const std::vector<int>& group_nodes,
                    const std::vector<double>& group_rows,
                    const std::vector<double>& group_residuals) {
  nodes.insert(nodes.end(), group_nodes.begin(), group_nodes.end());
  rows.insert(rows.end(), group_rows.begin(), group_rows.end());
  residuals.insert(residuals.end(), group_residuals.begin(),
                   group_residuals.end());
  begin.push_back(static_cast<int>(residuals.size()));
}

EnergyFloor::EnergyFloor(const SymmetricBlockMatrix& pattern, FloorRows points,
                         FloorRows edges)
    : points_(std::move(points)), edges_(std::move(edges)), shares_(1) {
  FloorMatrix& matrix = shares_[0];
  matrix.row_begin = pattern.row_begin();
  matrix.columns = pattern.columns();
  matrix.blocks.resize(36 * matrix.columns.size());
  matrix.gradient.resize(6 * pattern.size());
  PlaceBlocks(&points_);
  PlaceBlocks(&edges_);
  shares_.resize(tbb::this_task_arena::max_concurrency(), shares_[0]);
  inverse_.resize(36 * pattern.size());
  for (FloorArray* vector : {&x_, &r_, &z_, &d_, &q_}) {
    vector->resize(6 * pattern.size());
  }
}

void EnergyFloor::PlaceBlocks(FloorRows* rows) const {
  const FloorMatrix& matrix = shares_[0];
  const int n = rows->nodes_per_row;
  for (std::size_t i = 0; i < rows->nodes.size(); ++i) {
    const int row = rows->nodes[i];
    const auto begin = matrix.columns.begin() + matrix.row_begin[row];
    const auto end = matrix.columns.begin() + matrix.row_begin[row + 1];
    for (std::size_t j = i; j < (i / n + 1) * n; ++j) {
      rows->slots.push_back(
          static_cast<int>(std::lower_bound(begin, end, rows->nodes[j]) -
                           matrix.columns.begin()));
    }
  }
}

void EnergyFloor::Assemble() {
  const int count = static_cast<int>(shares_.size());
  tbb::parallel_for(0, count, [&](int i) {
    FloorMatrix& sum = shares_[i];
    std::fill(sum.blocks.begin(), sum.blocks.end(), 0.0);
    std::fill(sum.gradient.begin(), sum.gradient.end(), 0.0);
    SumPoints(points_, points_.groups() * i / count,
              points_.groups() * (i + 1) / count, &sum);
    SumEdges(edges_, edges_.groups() * i / count,
             edges_.groups() * (i + 1) / count, &sum);
  });
  const std::size_t size = shares_[0].blocks.size();
  tbb::parallel_for(0, count, [&](int part) {
    for (int i = 1; i < count; ++i) {
      AddUp(size * part / count, size * (part + 1) / count,
            shares_[i].blocks.data(), shares_[0].blocks.data());
    }
  });
  for (int i = 1; i < count; ++i) {
    AddUp(0, shares_[0].gradient.size(), shares_[i].gradient.data(),
          shares_[0].gradient.data());
  }
}

void EnergyFloor::Damp(double radius) {
  for (int i = 0; i < shares_[0].size(); ++i) {
    double* block = &shares_[0].blocks[36 * shares_[0].row_begin[i]];
    for (int d = 0; d < 36; d += 7) {
      block[d] += std::max(block[d], 1e-6) / radius;
    }
  }
}

int EnergyFloor::Solve(double tolerance, int max_iterations) {
  const FloorMatrix& a = shares_[0];
  const int nodes = a.size();
  const int n = 6 * nodes;
  for (int i = 0; i < nodes; ++i) {
    Invert(&a.blocks[36 * a.row_begin[i]], &inverse_[36 * i]);
  }
  for (int i = 0; i < n; ++i) r_[i] = -a.gradient[i];
  std::fill(x_.begin(), x_.end(), 0.0);
  double rz = MultiplyDiagonal(nodes, inverse_.data(), r_.data(), z_.data());
  d_ = z_;
  const double limit =
      tolerance * std::sqrt(DotProduct(n, r_.data(), r_.data()));
  for (int done = 0; done < max_iterations;) {
    MultiplySymmetric(nodes, a.row_begin.data(), a.columns.data(),
                      a.blocks.data(), d_.data(), q_.data());
    const double alpha = rz / DotProduct(n, d_.data(), q_.data());
    const double squared =
        StepAndResidual(n, alpha, d_.data(), q_.data(), x_.data(), r_.data());
    ++done;
    if (std::sqrt(squared) <= limit) return done;
    const double next =
        MultiplyDiagonal(nodes, inverse_.data(), r_.data(), z_.data());
    NextDirection(n, next / rz, z_.data(), d_.data());
    rz = next;
  }
  return max_iterations;
}

}  // namespace splitfusion
