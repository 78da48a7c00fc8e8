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
// The outer halves of [a0 a1 | .. ..] and [.. .. | b2 b3].
#define SPLITFUSION_HALVES(a, b) __builtin_shufflevector(a, b, 0, 1, 6, 7)
// [h2 h3 | l0 l1]: numbers 4, 5, 0, 1 of six, from 0..3 and 2..5.
#define SPLITFUSION_MIDDLE(l, h) __builtin_shufflevector(h, l, 2, 3, 4, 5)
#define SPLITFUSION_LOW(v) __builtin_shufflevector(v, v, 0, 1)
#define SPLITFUSION_HIGH(v) __builtin_shufflevector(v, v, 2, 3)
// Adds the sums of a pair of rows to `out`: of a and the low half of b, and of
// the high half of b and c.
#define SPLITFUSION_ADD_SUMS(a, b, c, out)                                \
  do {                                                                    \
    const Vector2 first =                                                 \
        (SPLITFUSION_LOW(a) + SPLITFUSION_HIGH(a)) + SPLITFUSION_LOW(b);  \
    const Vector2 second =                                                \
        SPLITFUSION_HIGH(b) + (SPLITFUSION_LOW(c) + SPLITFUSION_HIGH(c)); \
    (out) += __builtin_shufflevector(first, second, 0, 2) +               \
             __builtin_shufflevector(first, second, 1, 3);                \
  } while (false)
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
        const Vector4 middle = SPLITFUSION_MIDDLE(low, high);
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
void AddTransposedProduct(const double* a, const double* b, double* out) {
  Vector4* sum = reinterpret_cast<Vector4*>(out);
  Vector4 s0 = sum[0], s1 = sum[1], s2 = sum[2], s3 = sum[3], s4 = sum[4];
  Vector4 s5 = sum[5], s6 = sum[6], s7 = sum[7], s8 = sum[8];
  for (int row = 0; row < 6; ++row, a += 6, b += 6) {
    const Vector4 low = SPLITFUSION_LOAD4(b);
    const Vector4 high = SPLITFUSION_LOAD4(b + 2);
    const Vector4 middle = SPLITFUSION_MIDDLE(low, high);
    const Vector4 m0 = SPLITFUSION_FILL4(a[0]), m2 = SPLITFUSION_FILL4(a[1]);
    const Vector4 m3 = SPLITFUSION_FILL4(a[2]), m5 = SPLITFUSION_FILL4(a[3]);
    const Vector4 m6 = SPLITFUSION_FILL4(a[4]), m8 = SPLITFUSION_FILL4(a[5]);
    s0 += m0 * low;
    s1 += SPLITFUSION_HALVES(m0, m2) * middle;
    s2 += m2 * high;
    s3 += m3 * low;
    s4 += SPLITFUSION_HALVES(m3, m5) * middle;
    s5 += m5 * high;
    s6 += m6 * low;
    s7 += SPLITFUSION_HALVES(m6, m8) * middle;
    s8 += m8 * high;
  }
  sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3, sum[4] = s4;
  sum[5] = s5, sum[6] = s6, sum[7] = s7, sum[8] = s8;
}

SPLITFUSION_WIDE
void MultiplySymmetric(int size, const int* row_begin, const int* columns,
                       const double* blocks, const double* x, double* y) {
  std::fill_n(y, 6 * size, 0.0);
  for (int row = 0; row < size; ++row) {
    const double* own = x + 6 * row;
    const Vector4 m0 = SPLITFUSION_FILL4(own[0]);
    const Vector4 m2 = SPLITFUSION_FILL4(own[1]);
    const Vector4 m3 = SPLITFUSION_FILL4(own[2]);
    const Vector4 m5 = SPLITFUSION_FILL4(own[3]);
    const Vector4 m6 = SPLITFUSION_FILL4(own[4]);
    const Vector4 m8 = SPLITFUSION_FILL4(own[5]);
    const Vector4 m1 = SPLITFUSION_HALVES(m0, m2);
    const Vector4 m4 = SPLITFUSION_HALVES(m3, m5);
    const Vector4 m7 = SPLITFUSION_HALVES(m6, m8);
    const Vector4* v =
        reinterpret_cast<const Vector4*>(blocks + kBlock * row_begin[row]);
    Vector4 low = SPLITFUSION_LOAD4(own);
    Vector4 high = SPLITFUSION_LOAD4(own + 2);
    Vector4 middle = SPLITFUSION_MIDDLE(low, high);
    Vector4 s0 = v[0] * low, s1 = v[1] * middle, s2 = v[2] * high;
    Vector4 s3 = v[3] * low, s4 = v[4] * middle, s5 = v[5] * high;
    Vector4 s6 = v[6] * low, s7 = v[7] * middle, s8 = v[8] * high;
    for (int k = row_begin[row] + 1; k < row_begin[row + 1]; ++k) {
      v += 9;
      const double* other = x + 6 * columns[k];
      low = SPLITFUSION_LOAD4(other);
      high = SPLITFUSION_LOAD4(other + 2);
      middle = SPLITFUSION_MIDDLE(low, high);
      s0 += v[0] * low;
      s1 += v[1] * middle;
      s2 += v[2] * high;
      s3 += v[3] * low;
      s4 += v[4] * middle;
      s5 += v[5] * high;
      s6 += v[6] * low;
      s7 += v[7] * middle;
      s8 += v[8] * high;
      const Vector4 t0 = (m0 * v[0] + m3 * v[3]) + m6 * v[6];
      const Vector4 t1 = (m1 * v[1] + m4 * v[4]) + m7 * v[7];
      const Vector4 t2 = (m2 * v[2] + m5 * v[5]) + m8 * v[8];
      double* out = y + 6 * columns[k];
      *reinterpret_cast<Vector4*>(out) += t0 + SPLITFUSION_MIDDLE(t2, t1);
      *reinterpret_cast<Vector2*>(out + 4) +=
          SPLITFUSION_LOW(t1) + SPLITFUSION_HIGH(t2);
    }
    Vector2* out = reinterpret_cast<Vector2*>(y + 6 * row);
    SPLITFUSION_ADD_SUMS(s0, s1, s2, out[0]);
    SPLITFUSION_ADD_SUMS(s3, s4, s5, out[1]);
    SPLITFUSION_ADD_SUMS(s6, s7, s8, out[2]);
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
    const Vector4 low = t0 + SPLITFUSION_MIDDLE(t2, t1);
    const Vector2 high = SPLITFUSION_LOW(t1) + SPLITFUSION_HIGH(t2);
    *reinterpret_cast<Vector4*>(y + 6 * i) = low;
    *reinterpret_cast<Vector2*>(y + 6 * i + 4) = high;
    dot4 += low * SPLITFUSION_LOAD4(own);
    dot2 += high * *reinterpret_cast<const Vector2*>(own + 4);
  }
  return SPLITFUSION_SUM4(dot4) + (dot2[0] + dot2[1]);
}

SPLITFUSION_WIDE
double SolveFactorized(int size, const int* row_begin, const int* columns,
                       const double* blocks, const double* x, double* y) {
  std::copy_n(x, 6 * size, y);
  // U^T: what is done with a row is handed on to the rows below.
  for (int row = 0; row < size; ++row) {
    const double* own = y + 6 * row;
    const Vector4 m0 = SPLITFUSION_FILL4(own[0]);
    const Vector4 m2 = SPLITFUSION_FILL4(own[1]);
    const Vector4 m3 = SPLITFUSION_FILL4(own[2]);
    const Vector4 m5 = SPLITFUSION_FILL4(own[3]);
    const Vector4 m6 = SPLITFUSION_FILL4(own[4]);
    const Vector4 m8 = SPLITFUSION_FILL4(own[5]);
    const Vector4 m1 = SPLITFUSION_HALVES(m0, m2);
    const Vector4 m4 = SPLITFUSION_HALVES(m3, m5);
    const Vector4 m7 = SPLITFUSION_HALVES(m6, m8);
    for (int k = row_begin[row] + 1; k < row_begin[row + 1]; ++k) {
      const double* v = blocks + kBlock * k;
      const Vector4 t0 =
          (m0 * SPLITFUSION_LOAD4(v) + m3 * SPLITFUSION_LOAD4(v + 12)) +
          m6 * SPLITFUSION_LOAD4(v + 24);
      const Vector4 t1 =
          (m1 * SPLITFUSION_LOAD4(v + 4) + m4 * SPLITFUSION_LOAD4(v + 16)) +
          m7 * SPLITFUSION_LOAD4(v + 28);
      const Vector4 t2 =
          (m2 * SPLITFUSION_LOAD4(v + 8) + m5 * SPLITFUSION_LOAD4(v + 20)) +
          m8 * SPLITFUSION_LOAD4(v + 32);
      double* out = y + 6 * columns[k];
      *reinterpret_cast<Vector4*>(out) += t0 + SPLITFUSION_MIDDLE(t2, t1);
      *reinterpret_cast<Vector2*>(out + 4) +=
          SPLITFUSION_LOW(t1) + SPLITFUSION_HIGH(t2);
    }
  }
  // D and U: a row gathers from those below.
  Vector4 dot4 = {0, 0, 0, 0};
  Vector2 dot2 = {0, 0};
  for (int row = size - 1; row >= 0; --row) {
    Vector4 s0 = {0, 0, 0, 0}, s1 = s0, s2 = s0, s3 = s0, s4 = s0;
    Vector4 s5 = s0, s6 = s0, s7 = s0, s8 = s0;
    for (int k = row_begin[row]; k < row_begin[row + 1]; ++k) {
      const double* v = blocks + kBlock * k;
      const double* other = y + 6 * columns[k];
      // Loaded as the row below has stored them a moment ago.
      const Vector4 low = SPLITFUSION_LOAD4(other);
      const Vector2 last = *reinterpret_cast<const Vector2*>(other + 4);
      const Vector4 tail = __builtin_shufflevector(last, last, 0, 1, 0, 1);
      const Vector4 high = __builtin_shufflevector(low, tail, 2, 3, 4, 5);
      const Vector4 middle = __builtin_shufflevector(tail, low, 0, 1, 4, 5);
      s0 += SPLITFUSION_LOAD4(v) * low;
      s1 += SPLITFUSION_LOAD4(v + 4) * middle;
      s2 += SPLITFUSION_LOAD4(v + 8) * high;
      s3 += SPLITFUSION_LOAD4(v + 12) * low;
      s4 += SPLITFUSION_LOAD4(v + 16) * middle;
      s5 += SPLITFUSION_LOAD4(v + 20) * high;
      s6 += SPLITFUSION_LOAD4(v + 24) * low;
      s7 += SPLITFUSION_LOAD4(v + 28) * middle;
      s8 += SPLITFUSION_LOAD4(v + 32) * high;
    }
    Vector2 a = {0, 0}, b = a, c = a;
    SPLITFUSION_ADD_SUMS(s0, s1, s2, a);
    SPLITFUSION_ADD_SUMS(s3, s4, s5, b);
    SPLITFUSION_ADD_SUMS(s6, s7, s8, c);
    const Vector4 ab = __builtin_shufflevector(a, b, 0, 1, 2, 3);
    *reinterpret_cast<Vector4*>(y + 6 * row) = ab;
    *reinterpret_cast<Vector2*>(y + 6 * row + 4) = c;
    dot4 += ab * SPLITFUSION_LOAD4(x + 6 * row);
    dot2 += c * *reinterpret_cast<const Vector2*>(x + 6 * row + 4);
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
