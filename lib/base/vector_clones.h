#ifndef SPLITFUSION_LIB_BASE_VECTOR_CLONES_H_
#define SPLITFUSION_LIB_BASE_VECTOR_CLONES_H_

/// Before a function: it is compiled for wide vectors as well, and the
/// processor's own version is taken when the program starts. Only in files free
/// of Eigen, whose types change with the instruction set. No version fuses
/// multiplications with additions, so that all give the same numbers.
///
/// Files with loops that choose between numbers (`a < b ? a : b`) begin with
/// `#pragma GCC optimize("no-trapping-math")`: else the compiler keeps branches
/// in these loops for fear of a trap; "no-math-errno" does the same for roots.
/// Those of sums and products alone, the kernels of lib/energy, need neither.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define SPLITFUSION_VECTOR_CLONES \
  __attribute__((target_clones("avx2", "default")))
/// The same with AVX-512 as well, which can fuse them: only in files that begin
/// with `#pragma GCC optimize("fp-contract=off")`, too.
#define SPLITFUSION_WIDEST_VECTOR_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SPLITFUSION_VECTOR_CLONES
#define SPLITFUSION_WIDEST_VECTOR_CLONES
#endif

/// Functions that work on vectors are inlined into their callers, once for
/// every instruction set.
#define SPLITFUSION_INLINE inline __attribute__((always_inline))

#endif  // SPLITFUSION_LIB_BASE_VECTOR_CLONES_H_
