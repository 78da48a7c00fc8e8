#include "splitfusion/lib/energy/block_kernels.h"

#include <algorithm>

// Vectors of AVX2 where the processor has them. Multiplications and additions
// stay apart (no FMA): every clone rounds alike.
#if defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SPLITFUSION_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define SPLITFUSION_WIDE
#endif

namespace splitfusion {
namespace {

constexpr int kBlock = 36;
/// Rows whose multipliers AddOuterProducts keeps at hand.
constexpr int kRowsAtHand = 8;

// A pair of block rows of six numbers is three vectors of four:
// [r0: 0 1 2 3] [r0: 4 5, r1: 0 1] [r1: 2 3 4 5].
typedef double Vector4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double Vector2 __attribute__((vector_size(16), aligned(8), may_alias));

}  // namespace

#define SPLITFUSION_LOAD4(p) (*reinterpret_cast<const Vector4*>(p))
#define SPLITFUSION_FILL4(a) (Vector4{a, a, a, a})
#define SPLITFUSION_SUM4(v) (((v)[0] + (v)[2]) + ((v)[1] + (v)[3]))

SPLITFUSION_WIDE
void AddOuterProducts(const double* rows, int count, int nodes, int first,
                      const int* slots, double* blocks) {
  const int stride = 6 * nodes;
  Vector4 multipliers[kRowsAtHand][9];
  for (int begin = 0; begin < count; begin += kRowsAtHand) {
    const int at_hand = std::min(kRowsAtHand, count - begin);
    const double* chunk = rows + begin * stride;
    for (int r = 0; r < at_hand; ++r) {
      const double* j = chunk + r * stride + 6 * first;
      for (int pair = 0; pair < 3; ++pair, j += 2) {
        multipliers[r][3 * pair] = SPLITFUSION_FILL4(j[0]);
        multipliers[r][3 * pair + 1] = Vector4{j[0], j[0], j[1], j[1]};
        multipliers[r][3 * pair + 2] = SPLITFUSION_FILL4(j[1]);
      }
    }
    for (int l = first; l < nodes; ++l) {
      Vector4* out =
          reinterpret_cast<Vector4*>(blocks + kBlock * slots[l - first]);
      Vector4 s0 = out[0], s1 = out[1], s2 = out[2];
      Vector4 s3 = out[3], s4 = out[4], s5 = out[5];
      Vector4 s6 = out[6], s7 = out[7], s8 = out[8];
      for (int r = 0; r < at_hand; ++r) {
        const double* j = chunk + r * stride + 6 * l;
        const Vector4 low = SPLITFUSION_LOAD4(j);
        const Vector4 high = SPLITFUSION_LOAD4(j + 2);
        const Vector4 middle = __builtin_shufflevector(high, low, 2, 3, 4, 5);
        const Vector4* m = multipliers[r];
        s0 += m[0] * low;
        s1 += m[1] * middle;
        s2 += m[2] * high;
        s3 += m[3] * low;
        s4 += m[4] * middle;
        s5 += m[5] * high;
        s6 += m[6] * low;
        s7 += m[7] * middle;
        s8 += m[8] * high;
      }
      out[0] = s0, out[1] = s1, out[2] = s2;
      out[3] = s3, out[4] = s4, out[5] = s5;
      out[6] = s6, out[7] = s7, out[8] = s8;
    }
  }
}

SPLITFUSION_WIDE
void MultiplySymmetric(int size, const int* row_begin, const int* columns,
                       const double* blocks, const double* x, double* y) {
  std::fill_n(y, 6 * size, 0.0);
  for (int row = 0; row < size; ++row) {
    const double* own = x + 6 * row;
    Vector4 m[9] = {}, sum[9] = {};
    for (int pair = 0; pair < 3; ++pair) {
      const double a = own[2 * pair], b = own[2 * pair + 1];
      m[3 * pair] = SPLITFUSION_FILL4(a);
      m[3 * pair + 1] = Vector4{a, a, b, b};
      m[3 * pair + 2] = SPLITFUSION_FILL4(b);
    }
    const Vector4* v =
        reinterpret_cast<const Vector4*>(blocks + kBlock * row_begin[row]);
    Vector4 low = SPLITFUSION_LOAD4(own);
    Vector4 high = SPLITFUSION_LOAD4(own + 2);
    Vector4 middle = __builtin_shufflevector(high, low, 2, 3, 4, 5);
    for (int pair = 0; pair < 9; pair += 3) {
      sum[pair] = v[pair] * low;
      sum[pair + 1] = v[pair + 1] * middle;
      sum[pair + 2] = v[pair + 2] * high;
    }
    for (int k = row_begin[row] + 1; k < row_begin[row + 1]; ++k) {
      v += 9;
      const double* other = x + 6 * columns[k];
      low = SPLITFUSION_LOAD4(other);
      high = SPLITFUSION_LOAD4(other + 2);
      middle = __builtin_shufflevector(high, low, 2, 3, 4, 5);
      const Vector4 v0 = v[0], v1 = v[1], v2 = v[2];
      const Vector4 v3 = v[3], v4 = v[4], v5 = v[5];
      const Vector4 v6 = v[6], v7 = v[7], v8 = v[8];
      sum[0] += v0 * low;
      sum[1] += v1 * middle;
      sum[2] += v2 * high;
      sum[3] += v3 * low;
      sum[4] += v4 * middle;
      sum[5] += v5 * high;
      sum[6] += v6 * low;
      sum[7] += v7 * middle;
      sum[8] += v8 * high;
      const Vector4 t0 = (m[0] * v0 + m[3] * v3) + m[6] * v6;
      const Vector4 t1 = (m[1] * v1 + m[4] * v4) + m[7] * v7;
      const Vector4 t2 = (m[2] * v2 + m[5] * v5) + m[8] * v8;
      double* out = y + 6 * columns[k];
      *reinterpret_cast<Vector4*>(out) +=
          t0 + __builtin_shufflevector(t1, t2, 2, 3, 4, 5);
      *reinterpret_cast<Vector2*>(out + 4) +=
          __builtin_shufflevector(t1, t1, 0, 1) +
          __builtin_shufflevector(t2, t2, 2, 3);
    }
    double* out = y + 6 * row;
    for (int pair = 0; pair < 3; ++pair) {
      const Vector4* s = sum + 3 * pair;
      out[2 * pair] += SPLITFUSION_SUM4(s[0]) + (s[1][0] + s[1][1]);
      out[2 * pair + 1] += SPLITFUSION_SUM4(s[2]) + (s[1][2] + s[1][3]);
    }
  }
}

SPLITFUSION_WIDE
double MultiplyDiagonal(int size, const double* blocks, const double* x,
                        double* y) {
  Vector4 dot4 = {0, 0, 0, 0};
  Vector2 dot2 = {0, 0};
  for (int i = 0; i < size; ++i) {
    const Vector4* v = reinterpret_cast<const Vector4*>(blocks + kBlock * i);
    const double* own = x + 6 * i;
    Vector4 t0 = {0, 0, 0, 0}, t1 = t0, t2 = t0;
    for (int pair = 0; pair < 3; ++pair) {
      const double a = own[2 * pair], b = own[2 * pair + 1];
      t0 += SPLITFUSION_FILL4(a) * v[3 * pair];
      t1 += (Vector4{a, a, b, b}) * v[3 * pair + 1];
      t2 += SPLITFUSION_FILL4(b) * v[3 * pair + 2];
    }
    const Vector4 low = t0 + __builtin_shufflevector(t1, t2, 2, 3, 4, 5);
    const Vector2 high = __builtin_shufflevector(t1, t1, 0, 1) +
                         __builtin_shufflevector(t2, t2, 2, 3);
    *reinterpret_cast<Vector4*>(y + 6 * i) = low;
    *reinterpret_cast<Vector2*>(y + 6 * i + 4) = high;
    dot4 += low * SPLITFUSION_LOAD4(own);
    dot2 += high * *reinterpret_cast<const Vector2*>(own + 4);
  }
  return SPLITFUSION_SUM4(dot4) + (dot2[0] + dot2[1]);
}

SPLITFUSION_WIDE
double DotProduct(int n, const double* a, const double* b) {
  Vector4 sum = {0, 0, 0, 0};
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    sum += SPLITFUSION_LOAD4(a + i) * SPLITFUSION_LOAD4(b + i);
  }
  double total = SPLITFUSION_SUM4(sum);
  for (; i < n; ++i) total += a[i] * b[i];
  return total;
}

SPLITFUSION_WIDE
double StepAndResidual(int n, double alpha, const double* d, const double* q,
                       double* x, double* r) {
  const Vector4 alpha4 = SPLITFUSION_FILL4(alpha);
  Vector4 sum = {0, 0, 0, 0};
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    *reinterpret_cast<Vector4*>(x + i) += alpha4 * SPLITFUSION_LOAD4(d + i);
    const Vector4 next =
        SPLITFUSION_LOAD4(r + i) - alpha4 * SPLITFUSION_LOAD4(q + i);
    *reinterpret_cast<Vector4*>(r + i) = next;
    sum += next * next;
  }
  double total = SPLITFUSION_SUM4(sum);
  for (; i < n; ++i) {
    x[i] += alpha * d[i];
    r[i] -= alpha * q[i];
    total += r[i] * r[i];
  }
  return total;
}

SPLITFUSION_WIDE
void NextDirection(int n, double beta, const double* z, double* d) {
  for (int i = 0; i < n; ++i) d[i] = z[i] + beta * d[i];
}

}  // namespace splitfusion
