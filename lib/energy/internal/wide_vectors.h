#ifndef SPLITFUSION_LIB_ENERGY_INTERNAL_WIDE_VECTORS_H_
#define SPLITFUSION_LIB_ENERGY_INTERNAL_WIDE_VECTORS_H_

// For the kernels of this folder only: vectors of four and two numbers and what
// is done with them. Macros, since functions that take wide vectors differ by
// instruction set. Files that include this are free of Eigen, and their
// functions are SPLITFUSION_VECTOR_CLONES.

namespace splitfusion {

// A pair of block rows of six numbers is three vectors of four:
// [r0: 0 1 2 3] [r0: 4 5, r1: 0 1] [r1: 2 3 4 5].
typedef double Vector4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double Vector2 __attribute__((vector_size(16), aligned(8), may_alias));

}  // namespace splitfusion

#define SPLITFUSION_LOAD4(p) (*reinterpret_cast<const Vector4*>(p))
#define SPLITFUSION_FILL4(a) (Vector4{a, a, a, a})
// The outer halves of [a0 a1 | .. ..] and [.. .. | b2 b3].
#define SPLITFUSION_HALVES(a, b) __builtin_shufflevector(a, b, 0, 1, 6, 7)
// [h2 h3 | l0 l1]: numbers 4, 5, 0, 1 of six, from 0..3 and 2..5.
#define SPLITFUSION_MIDDLE(l, h) __builtin_shufflevector(h, l, 2, 3, 4, 5)
#define SPLITFUSION_LOW(v) __builtin_shufflevector(v, v, 0, 1)
#define SPLITFUSION_HIGH(v) __builtin_shufflevector(v, v, 2, 3)
// [a0 b0 | a2 b2], [a1 b1 | a3 b3], [a0 a1 | b0 b1], [a2 a3 | b2 b3]
#define SPLITFUSION_EVEN(a, b) __builtin_shufflevector(a, b, 0, 4, 2, 6)
#define SPLITFUSION_ODD(a, b) __builtin_shufflevector(a, b, 1, 5, 3, 7)
#define SPLITFUSION_LOWS(a, b) __builtin_shufflevector(a, b, 0, 1, 4, 5)
#define SPLITFUSION_HIGHS(a, b) __builtin_shufflevector(a, b, 2, 3, 6, 7)
#define SPLITFUSION_JOINED(low, high) \
  __builtin_shufflevector(low, high, 0, 1, 2, 3)
#define SPLITFUSION_SUM4(v) (((v)[0] + (v)[2]) + ((v)[1] + (v)[3]))

#endif  // SPLITFUSION_LIB_ENERGY_INTERNAL_WIDE_VECTORS_H_
