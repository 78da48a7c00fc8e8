#include "splitfusion/lib/energy/block_kernels.h"

#include <algorithm>

#include "splitfusion/lib/base/vector_clones.h"
#include "splitfusion/lib/energy/internal/wide_vectors.h"

namespace splitfusion {
namespace {

constexpr int kBlock = 36;  // Layout.

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

/// The nine vectors of a block, or what its rows are multiplied with.
struct NineVectors {
  Vector4 v0, v1, v2, v3, v4, v5, v6, v7, v8;
};

/// Six numbers as the columns of a pair of rows see them.
struct SixColumns {
  Vector4 low, middle, high;
};

SPLITFUSION_INLINE void LoadColumns(const double* six, SixColumns* columns) {
  columns->low = SPLITFUSION_LOAD4(six);
  columns->high = SPLITFUSION_LOAD4(six + 2);
  columns->middle = SPLITFUSION_MIDDLE(columns->low, columns->high);
}

/// Six numbers, each along its row of a block.
SPLITFUSION_INLINE void FillRows(const double* six, NineVectors* rows) {
  const Vector4 m0 = SPLITFUSION_FILL4(six[0]), m2 = SPLITFUSION_FILL4(six[1]);
  const Vector4 m3 = SPLITFUSION_FILL4(six[2]), m5 = SPLITFUSION_FILL4(six[3]);
  const Vector4 m6 = SPLITFUSION_FILL4(six[4]), m8 = SPLITFUSION_FILL4(six[5]);
  *rows = {m0, SPLITFUSION_HALVES(m0, m2), m2,
           m3, SPLITFUSION_HALVES(m3, m5), m5,
           m6, SPLITFUSION_HALVES(m6, m8), m8};
}

/// sums += each number of the block times that of its column.
SPLITFUSION_INLINE void AddProducts(const NineVectors& block,
                                    const SixColumns& columns,
                                    NineVectors* sums) {
  sums->v0 += block.v0 * columns.low;
  sums->v1 += block.v1 * columns.middle;
  sums->v2 += block.v2 * columns.high;
  sums->v3 += block.v3 * columns.low;
  sums->v4 += block.v4 * columns.middle;
  sums->v5 += block.v5 * columns.high;
  sums->v6 += block.v6 * columns.low;
  sums->v7 += block.v7 * columns.middle;
  sums->v8 += block.v8 * columns.high;
}

/// Sums along the six rows of a block.
SPLITFUSION_INLINE void SumRows(const NineVectors& block, Vector2* sums) {
  SPLITFUSION_ADD_SUMS(block.v0, block.v1, block.v2, sums[0]);
  SPLITFUSION_ADD_SUMS(block.v3, block.v4, block.v5, sums[1]);
  SPLITFUSION_ADD_SUMS(block.v6, block.v7, block.v8, sums[2]);
}

/// out += B^T x: `rows` are the six numbers of x by FillRows().
SPLITFUSION_INLINE void AddTransposed(const NineVectors& rows,
                                      const NineVectors& block, double* out) {
  const Vector4 t0 =
      (rows.v0 * block.v0 + rows.v3 * block.v3) + rows.v6 * block.v6;
  const Vector4 t1 =
      (rows.v1 * block.v1 + rows.v4 * block.v4) + rows.v7 * block.v7;
  const Vector4 t2 =
      (rows.v2 * block.v2 + rows.v5 * block.v5) + rows.v8 * block.v8;
  *reinterpret_cast<Vector4*>(out) += t0 + SPLITFUSION_MIDDLE(t2, t1);
  *reinterpret_cast<Vector2*>(out + 4) +=
      SPLITFUSION_LOW(t1) + SPLITFUSION_HIGH(t2);
}

/// out += sum of a_r^T b_r over `count` rows of six numbers at a, b.
SPLITFUSION_INLINE void AddRowProducts(const double* a, const double* b,
                                       int count, int stride, double* out) {
  NineVectors& target = *reinterpret_cast<NineVectors*>(out);
  NineVectors sums = target;
  for (int r = 0; r < count; ++r, a += stride, b += stride) {
    NineVectors rows = {};
    SixColumns columns;
    FillRows(a, &rows);
    LoadColumns(b, &columns);
    AddProducts(rows, columns, &sums);
  }
  target = sums;
}

/// Of each of kSides vectors of factors, `count` numbers one after the other,
/// adds the sum of factors_r rows_r to the six numbers at `out`, `apart` from
/// one vector to the next. `stride`: from row to row.
template <int kSides>
SPLITFUSION_INLINE void AddScaledRows(const double* factors, const double* rows,
                                      int count, int stride, double* out,
                                      int apart) {
  Vector4 sums4[kSides];
  Vector2 sums2[kSides];
  for (int s = 0; s < kSides; ++s) {
    sums4[s] = SPLITFUSION_LOAD4(out + apart * s);
    sums2[s] = *reinterpret_cast<const Vector2*>(out + apart * s + 4);
  }
  for (int r = 0; r < count; ++r, rows += stride) {
    const Vector4 row4 = SPLITFUSION_LOAD4(rows);
    const Vector2 row2 = *reinterpret_cast<const Vector2*>(rows + 4);
    for (int s = 0; s < kSides; ++s) {
      const double factor = factors[count * s + r];
      sums4[s] += SPLITFUSION_FILL4(factor) * row4;
      sums2[s] += (Vector2{factor, factor}) * row2;
    }
  }
  for (int s = 0; s < kSides; ++s) {
    *reinterpret_cast<Vector4*>(out + apart * s) = sums4[s];
    *reinterpret_cast<Vector2*>(out + apart * s + 4) = sums2[s];
  }
}

SPLITFUSION_INLINE const NineVectors& BlockAt(const double* blocks, int index) {
  return *reinterpret_cast<const NineVectors*>(blocks + kBlock * index);
}

}  // namespace

SPLITFUSION_VECTOR_CLONES
void AddOuterProducts(const double* rows, int count, int nodes, int first,
                      const int* slots, double* blocks) {
  for (int l = first; l < nodes; ++l) {
    AddRowProducts(rows + 6 * first, rows + 6 * l, count, 6 * nodes,
                   blocks + kBlock * slots[l - first]);
  }
}

SPLITFUSION_VECTOR_CLONES
void MultiplySymmetric(int size, const int* row_begin, const int* columns,
                       const double* blocks, const double* x, double* y) {
  std::fill_n(y, 6 * size, 0.0);
  for (int row = 0; row < size; ++row) {
    NineVectors own = {}, sums = {};
    SixColumns six;
    FillRows(x + 6 * row, &own);
    LoadColumns(x + 6 * row, &six);
    AddProducts(BlockAt(blocks, row_begin[row]), six, &sums);
    for (int k = row_begin[row] + 1; k < row_begin[row + 1]; ++k) {
      const NineVectors& block = BlockAt(blocks, k);
      LoadColumns(x + 6 * columns[k], &six);
      AddProducts(block, six, &sums);
      AddTransposed(own, block, y + 6 * columns[k]);
    }
    SumRows(sums, reinterpret_cast<Vector2*>(y + 6 * row));
  }
}

SPLITFUSION_VECTOR_CLONES
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

SPLITFUSION_VECTOR_CLONES
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

SPLITFUSION_VECTOR_CLONES
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

SPLITFUSION_VECTOR_CLONES
void AddGradients(int sides, const double* residuals, const double* rows,
                  int count, int columns, double* gradients) {
  int s = 0;
  for (; s + 2 <= sides; s += 2) {
    for (int c = 0; c < columns; c += 6) {
      AddScaledRows<2>(residuals + count * s, rows + c, count, columns,
                       gradients + columns * s + c, columns);
    }
  }
  for (int c = 0; s < sides && c < columns; c += 6) {
    AddScaledRows<1>(residuals + count * s, rows + c, count, columns,
                     gradients + columns * s + c, columns);
  }
}

SPLITFUSION_VECTOR_CLONES
void AddScaled(int n, double alpha, const double* x, double* y) {
  for (int i = 0; i < n; ++i) y[i] += alpha * x[i];
}

SPLITFUSION_VECTOR_CLONES
void NextDirection(int n, double beta, const double* z, double* d) {
  for (int i = 0; i < n; ++i) d[i] = z[i] + beta * d[i];
}

}  // namespace splitfusion
